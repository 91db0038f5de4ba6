#include "reports/regression/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "reports/statistics/statistics.hpp"

namespace odobench {
namespace {

using FigureOfRun = std::function<std::optional<double>(std::size_t)>;  // of a run by its place in the row

class Collector {
 public:
  explicit Collector(const ComparisonRow& row) : row_(row) {
    for (const RunRecord* run : row.runs) {
      errors_.push_back(error_statistics(run->errors));
      for (const TrajectoryErrors& e : errors_.back())
        if (std::find(trajectories_.begin(), trajectories_.end(), e.trajectory) == trajectories_.end())
          trajectories_.push_back(e.trajectory);
    }
  }

  std::vector<Metric> collect() {
    add({"J", "J", "", Better::Lower, false, false, {}}, [&](std::size_t i) { return run(i).cost; });
    totals();
    trajectories();
    if (row_.kind == "run") effort();
    measures();
    return std::move(metrics_);
  }

 private:
  const RunRecord& run(std::size_t i) const { return *row_.runs[i]; }

  void add(Metric metric, const FigureOfRun& figure) {
    const double worst = metric.better == Better::Lower    ? std::numeric_limits<double>::infinity()
                         : metric.better == Better::Higher ? -std::numeric_limits<double>::infinity()
                                                           : std::numeric_limits<double>::quiet_NaN();
    bool any = false;
    for (std::size_t i = 0; i < row_.runs.size(); ++i) {
      const std::optional<double> value = figure(i);
      any = any || value;
      metric.values.push_back(value && !std::isnan(*value) ? *value : worst);
    }
    // A row whose runs all failed still has a cost: the worst.
    if (any || metric.name == "J") metrics_.push_back(std::move(metric));
  }

  // Sums over fewer trajectories than the other runs have are no sums.
  void totals() {
    const auto totals_of = [&](std::size_t i) -> std::optional<Totals> {
      if (errors_[i].empty() || errors_[i].size() != trajectories_.size()) return std::nullopt;
      return error_totals(errors_[i]);
    };
    add({"total", "total", "m + rad", Better::Lower, false, false, {}}, [&](std::size_t i) {
      const auto totals = totals_of(i);
      return totals ? std::optional<double>(totals->total) : std::nullopt;
    });
    for (std::size_t v = 0; v < 3; ++v) {
      const std::string name = std::string("total_") + kPoseVariables[v];
      add({name, name, v == 2 ? "rad" : "m", Better::Lower, false, false, {}}, [&](std::size_t i) {
        const auto totals = totals_of(i);
        return totals ? std::optional<double>(totals->sums[v]) : std::nullopt;
      });
    }
  }

  void trajectories() {
    for (const std::string& trajectory : trajectories_)
      for (std::size_t v = 0; v < 3; ++v)
        add({"e_sr." + trajectory + "." + kPoseVariables[v],
             "e_sr",
             v == 2 ? "rad" : "m",
             Better::Lower,
             false,
             false,
             {}},
            [&](std::size_t i) -> std::optional<double> {
              const TrajectoryErrors* errors = find_trajectory(errors_[i], trajectory);
              return errors == nullptr ? std::nullopt : std::optional<double>(errors->variables[v].mean);
            });
  }

  void effort() {
    add({"evaluations", "evaluations", "", Better::Lower, true, false, {}},
        [&](std::size_t i) { return std::optional<double>(static_cast<double>(run(i).evaluations)); });
    add({"iterations", "iterations", "", Better::Lower, true, false, {}},
        [&](std::size_t i) { return std::optional<double>(static_cast<double>(run(i).iterations)); });
    add({"seconds", "seconds", "s", Better::Lower, true, true, {}},
        [&](std::size_t i) { return std::optional<double>(run(i).seconds); });
  }

  // What a measure is, its first run says.
  void measures() {
    Measures all;
    for (const RunRecord* one : row_.runs)
      for (const Measure& measure : one->measures)
        if (all.find(measure.name) == nullptr) all.put(measure);
    for (const Measure& measure : all)
      add({measure.name, "statistics", measure.unit, measure.better, false, measure.timing, {}},
          [&](std::size_t i) { return run(i).measures.value(measure.name); });
  }

  const ComparisonRow& row_;
  std::vector<std::vector<TrajectoryErrors>> errors_;  // per run
  std::vector<std::string> trajectories_;
  std::vector<Metric> metrics_;
};

}  // namespace

std::vector<Metric> metrics_of(const ComparisonRow& row) {
  if (row.kind == "skipped") return {};
  return Collector(row).collect();
}

const Metric* find_metric(const std::vector<Metric>& metrics, const std::string& name) {
  for (const Metric& metric : metrics)
    if (metric.name == name) return &metric;
  return nullptr;
}

}  // namespace odobench
