#include "datasets/logs/log_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/error.hpp"
#include "base/names.hpp"
#include "base/text.hpp"

namespace odobench {

void refuse_unknown(const std::string& kind, const std::string& name, const std::string& place,
                    const std::vector<std::string>& known) {
  constexpr std::size_t most = 20;
  std::string list;
  for (std::size_t i = 0; i < std::min(most, known.size()); ++i)
    list += (i > 0 ? ", " : "") + (known[i].empty() ? std::string("''") : shown(known[i]));
  if (known.size() > most) list += fmt::format(", ... ({} in all)", known.size());
  if (known.empty()) list = "none";
  throw std::invalid_argument(fmt::format("no {} '{}' in {}{}{} it has {}", kind, shown(name), place,
                                          printable(did_you_mean(name, known)),
                                          nearest_name(name, known).empty() ? ":" : "", list));
}

void RowTimes::add(std::int64_t stamp_ns) {
  if (!any_) first_ = last_ = stamp_ns;
  any_ = true;
  gap_ = std::max(gap_, stamp_ns - last_);
  last_ = stamp_ns;
}

void RowTimes::give(LogSource& source) const {
  source.first_ns = first_;
  source.last_ns = last_;
  source.largest_gap_ns = gap_;
}

std::string counted(std::int64_t count, const std::string& what) {
  std::string digits = std::to_string(count);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
  return fmt::format("{} {}{}", digits, what, count == 1 ? "" : "s");
}

void refuse_too_many_values(const std::string& file) {
  throw DataError(fmt::format("{}: more than 100,000,000 values asked for, expected fewer fields", file));
}

}  // namespace odobench
