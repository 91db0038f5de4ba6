#include "reports/kinds/trust/bootstrap_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "reports/records/series.hpp"

namespace odobench {
namespace {

constexpr std::array kCostPercentiles{"bootstrap.cost.p2_5", "bootstrap.cost.p50", "bootstrap.cost.p97_5"};
constexpr double kNearBound = 1e-6;

BootstrapSpread spread_of(const std::vector<double>& values) {
  BootstrapSpread out;
  double mean = 0, squares = 0;
  const auto count = static_cast<double>(values.size());
  for (const double v : values) mean += v / count;
  for (const double v : values) squares += (v - mean) * (v - mean);
  out.deviation =
      values.size() < 2 ? std::numeric_limits<double>::quiet_NaN() : std::sqrt(squares / (count - 1));
  for (std::size_t k = 0; k < kBootstrapPercentiles.size(); ++k)
    out.percentiles[k] = percentile(values, kBootstrapPercentiles[k]);
  return out;
}

}  // namespace

double percentile(std::vector<double> values, double percent) {
  if (values.empty()) throw std::invalid_argument("percentile: no values, expected at least one");
  std::sort(values.begin(), values.end());
  const double place = percent / 100 * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(place));
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

void put_bootstrap(const BootstrapFigures& figures, RunRecord& record) {
  const BootstrapSpread cost = cost_spread(figures);
  record.measures.put({"bootstrap.replicates", static_cast<double>(figures.replicates()), ""});
  record.measures.put({"bootstrap.stratified", figures.scheme == "stratified" ? 1.0 : 0.0, ""});
  for (std::size_t k = 0; k < kCostPercentiles.size(); ++k)
    record.measures.put({kCostPercentiles[k], cost.percentiles[k], ""});
  record.series["bootstrap.recordings"] = figures.recordings;
  record.series["bootstrap.cost"] = figures.costs;
  record.series["bootstrap.parameters"] = figures.parameters;
}

std::optional<BootstrapFigures> bootstrap_of(const RunRecord& record) {
  const auto costs = record.series.find("bootstrap.cost");
  if (costs == record.series.end() || costs->second.empty()) return std::nullopt;
  const std::size_t count = costs->second.size();
  const auto* recordings = series_of(record, "bootstrap.recordings", count * record.errors.size());
  const auto* parameters = series_of(record, "bootstrap.parameters", count * record.parameters.size());
  if (recordings == nullptr || parameters == nullptr) return std::nullopt;
  const bool plain = record.measures.value("bootstrap.stratified") == 0.0;
  return BootstrapFigures{plain ? "plain" : "stratified", *recordings, costs->second, *parameters};
}

BootstrapSpread parameter_spread(const BootstrapFigures& figures, const RunRecord& record,
                                 std::size_t parameter) {
  const ParameterValue& p = record.parameters.at(parameter);
  const double near = kNearBound * (p.upper - p.lower);
  std::vector<double> values;
  double at_bound = 0;
  for (std::size_t k = 0; k < figures.replicates(); ++k) {
    values.push_back(figures.parameters[k * record.parameters.size() + parameter]);
    if (values.back() <= p.lower + near || values.back() >= p.upper - near) ++at_bound;
  }
  BootstrapSpread out = spread_of(values);
  out.share_at_bound = at_bound / static_cast<double>(figures.replicates());
  return out;
}

BootstrapSpread cost_spread(const BootstrapFigures& figures) {
  return spread_of(figures.costs);
}

}  // namespace odobench
