#include "reports/regression/metrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>

#include "reports/statistics/statistics.hpp"

namespace odobench {
namespace {

using FigureOfRun = std::function<std::optional<double>(std::size_t)>;  // of a run by its place in the row

struct Direction {
  const char* prefix;
  const char* suffix;
  Better better;
};
// Of the statistics in reports/kinds/entropy/entropy_tables.hpp and reports/kinds/entropy/window_tables.hpp;
// others have no direction.
constexpr std::array<Direction, 9> kDirections{{{"windows_per_second", "", Better::Higher},
                                                {"at_optimum", "", Better::Higher},
                                                {"gain_", "", Better::Higher},
                                                {"hamiltonian_mean", "", Better::Higher},
                                                {"gap_", "", Better::Lower},
                                                {"iterations_", "", Better::Lower},
                                                {"evaluations_", "", Better::Lower},
                                                {"noise.", ".after", Better::Lower},
                                                {"track.", ".after", Better::Lower}}};

Better direction_of(const std::string& name) {
  const auto ends_with = [&](const std::string& end) {
    return name.size() >= end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
  };
  for (const Direction& d : kDirections)
    if (name.rfind(d.prefix, 0) == 0 && ends_with(d.suffix)) return d.better;
  return Better::None;
}

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
    statistics();
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

  void statistics() {
    std::set<std::string> names;
    for (const RunRecord* one : row_.runs)
      for (const auto& [name, value] : one->statistics) names.insert(name);
    for (const std::string& name : names)
      add({name, "statistics", "", direction_of(name), false, name == "windows_per_second", {}},
          [&](std::size_t i) -> std::optional<double> {
            const auto found = run(i).statistics.find(name);
            return found == run(i).statistics.end() ? std::nullopt : std::optional<double>(found->second);
          });
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
