#include "datasets/native/columns.hpp"

#include <algorithm>
#include <cmath>

#include "base/range.hpp"

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

std::optional<ColumnFault> find_reference_fault(const Recording& recording) {
  const std::vector<std::size_t>& at = recording.reference.sample;
  for (std::size_t i = 0; i < at.size(); ++i)
    if (at[i] >= recording.size() || (i > 0 && at[i] <= at[i - 1]))
      return ColumnFault{"x", at[i],
                         fmt::format("found sample {} as number {} of the reference, expected increasing "
                                     "samples below {}",
                                     at[i], i, recording.size())};
  return {};
}

}  // namespace

std::string column_name(const Signal& signal, int schema) {
  if (schema > 1) return signal.name;
  const std::size_t dot = signal.name.find('.');
  if (dot == std::string::npos) return signal.name;
  const std::string number = signal.name.substr(dot + 1);
  return (signal.kind == SignalKind::Speed ? "wheel_speed_" : signal.name.substr(0, dot) + "_") + number;
}

std::optional<ColumnFault> find_fault(const Recording& recording, int schema) {
  std::optional<ColumnFault> fault = find_stamp_fault(recording.time_us);
  if (!fault) fault = find_reference_fault(recording);
  // All stamps without a reference leave nothing behind, not even a list.
  if (!fault && schema > 1 && recording.reference.sample.empty() && recording.reference.x.empty())
    fault = ColumnFault{"x", {}, "found no reference at any stamp, expected one at least"};
  const std::size_t references =
      recording.reference.sample.empty() ? recording.size() : recording.reference.sample.size();
  std::size_t column = 0;
  for_each_value_column(
      recording, schema, [&](const std::string& name, const char*, const std::vector<double>& values) {
        if (fault) return;
        const bool of_reference = column++ < 3;
        const std::size_t expected = of_reference ? references : recording.size();
        const auto stamp = [&](std::size_t k) {
          return of_reference && !recording.reference.sample.empty() ? recording.reference.sample[k] : k;
        };
        if (values.size() != expected) {
          fault =
              ColumnFault{name,
                          {},
                          fmt::format("found {} values, expected {}{}", values.size(), expected,
                                      expected == recording.size() ? " as in time_us" : " of the reference")};
          return;
        }
        for (std::size_t k = 0; k < values.size(); ++k)
          if (!std::isfinite(values[k])) {
            fault = ColumnFault{name, stamp(k), fmt::format("found {}, expected a finite number", values[k])};
            return;
          }
      });
  return fault;
}

Recording with_reference_everywhere(const Recording& recording) {
  Recording whole = recording;
  const Reference& some = recording.reference;
  if (some.sample.empty()) return whole;
  const std::vector<double> none(recording.size(), kNotANumber);
  whole.reference = {{}, none, none, none};
  for (std::size_t i = 0; i < some.sample.size(); ++i) {
    whole.reference.x[some.sample[i]] = some.x[i];
    whole.reference.y[some.sample[i]] = some.y[i];
    whole.reference.theta[some.sample[i]] = some.theta[i];
  }
  return whole;
}

void drop_missing_reference(Recording& recording) {
  Reference& r = recording.reference;
  if (r.x.size() != recording.size() || r.y.size() != recording.size() || r.theta.size() != recording.size())
    return;
  Reference some;
  for (std::size_t k = 0; k < recording.size(); ++k) {
    if (std::isnan(r.x[k]) && std::isnan(r.y[k]) && std::isnan(r.theta[k])) continue;
    some.sample.push_back(k);
    some.x.push_back(r.x[k]);
    some.y.push_back(r.y[k]);
    some.theta.push_back(r.theta[k]);
  }
  if (some.sample.size() < recording.size()) r = std::move(some);
}

}  // namespace odobench
