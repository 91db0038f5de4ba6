#include "bench/studies/trust/trust_choice.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "base/text.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"

namespace odobench {

ValidationChoice validation_choice(const std::string& text) {
  constexpr int kMostFolds = 10000;
  ValidationChoice choice{false, false, false, 0, false};
  const std::vector<std::string> items = comma_items(text);
  for (const std::string& item : items) {
    if (item == "none" && items.size() == 1) return choice;
    if (item == "repetitions") {
      choice.repetitions = true;
    } else if (item == "trajectories") {
      choice.trajectories = true;
    } else if (item == "all") {
      choice.repetitions = choice.trajectories = choice.own_solvers = true;
    } else if (item.rfind("kfold:", 0) == 0) {
      choice.k_fold = static_cast<int>(whole_number("--validate=kfold", item.substr(6), 2, kMostFolds));
    } else {
      throw std::invalid_argument(fmt::format(
          "--validate={}: found '{}', expected repetitions, trajectories, kfold:K, all, or none alone",
          shown(text), shown(item)));
    }
  }
  return choice;
}

}  // namespace odobench
