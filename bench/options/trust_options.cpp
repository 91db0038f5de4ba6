#include "bench/options/trust_options.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "bench/options/common_options.hpp"

namespace odobench {

void add_validation(CLI::App& app, ValidationChoice& choice) {
  add_value(
      app, "--validate", "LIST",
      "errors on recordings that the fit has not seen: repetitions, trajectories, kfold:K; all: the first "
      "two by fits of each row's own solver; none [repetitions,trajectories where it takes little]",
      [&choice](const std::string& text) { choice = validation_choice(text); });
}

void add_bootstrap(CLI::App& app, TrustChoice& choice) {
  constexpr int kMostReplicates = 100000;
  add_count(app, "--bootstrap", choice.bootstrap, 0, kMostReplicates,
            "fits to sets of recordings drawn with replacement, of the lowest result; a call that was killed "
            "goes on with --out and --overwrite [0]");
  add_value(app, "--bootstrap-scheme", "stratified|plain",
            "draw within kinds of drives, or from all recordings [stratified]",
            [&choice](const std::string& text) {
              try {
                choice.scheme = resample_scheme(text);
              } catch (const std::invalid_argument& error) {
                throw std::invalid_argument(fmt::format("--bootstrap-scheme={}", error.what()));
              }
            });
}

}  // namespace odobench
