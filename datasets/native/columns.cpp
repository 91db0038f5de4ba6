#include "datasets/native/columns.hpp"

#include <cmath>

namespace odobench {
namespace {

std::optional<ColumnFault> find_stamp_fault(const std::vector<std::int64_t>& time_us) {
  if (time_us.size() < 2)
    return ColumnFault{"time_us", {}, fmt::format("found {} samples, expected at least 2", time_us.size())};
  if (time_us[0] != 0)
    return ColumnFault{"time_us", 0, fmt::format("found a first stamp of {} us, expected 0", time_us[0])};
  for (std::size_t k = 1; k < time_us.size(); ++k)
    if (time_us[k] <= time_us[k - 1])
      return ColumnFault{
          "time_us", k,
          fmt::format("found {} us after {} us, expected a later stamp", time_us[k], time_us[k - 1])};
  return {};
}

}  // namespace

std::optional<ColumnFault> find_fault(const Recording& recording) {
  std::optional<ColumnFault> fault = find_stamp_fault(recording.time_us);
  for_each_value_column(
      recording, [&](const std::string& name, const char*, const std::vector<double>& values) {
        if (fault) return;
        if (values.size() != recording.size()) {
          fault = ColumnFault{
              name,
              {},
              fmt::format("found {} values, expected {} as in time_us", values.size(), recording.size())};
          return;
        }
        for (std::size_t k = 0; k < values.size(); ++k)
          if (!std::isfinite(values[k])) {
            fault = ColumnFault{name, k, fmt::format("found {}, expected a finite number", values[k])};
            return;
          }
      });
  return fault;
}

}  // namespace odobench
