#include "reports/statistics/optimisers/trials.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/range.hpp"

namespace odobench {
namespace {

// What is shared by the runs of one instance: J* and the unit of gaps.
struct Scale {
  std::optional<double> known;
  double lowest = kInfinity;
  std::vector<double> starts;

  double best() const { return known.value_or(lowest); }
  double unit(bool absolute) const {
    if (absolute || starts.empty()) return 1;
    std::vector<double> sorted = starts;
    std::sort(sorted.begin(), sorted.end());
    const double median = (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]) / 2;
    return std::isfinite(median) && median > best() ? median - best() : 1;
  }
};

using InstanceKey = std::string;

InstanceKey key_of(const RunRecord& r) {
  return r.problem + '\n' + r.dataset + '\n' + r.dataset_sha256 + '\n' + r.box;
}

bool is_absolute(const std::string& problem) {
  return problem.rfind("bbob:", 0) == 0;
}

void gather(const RunRecord& r, Scale& scale) {
  if (r.known) scale.known = r.known->cost;
  if (r.cost && std::isfinite(*r.cost)) scale.lowest = std::min(scale.lowest, *r.cost);
  bool first = true;
  for (const TracePoint& p : r.trace) {
    if (!std::isfinite(p.cost)) continue;
    if (first) scale.starts.push_back(p.cost);
    first = false;
    scale.lowest = std::min(scale.lowest, p.cost);
  }
}

Trial trial_of(const RunRecord& r, const Scale& scale) {
  Trial trial;
  trial.problem = r.problem;
  trial.repetition = r.repetition;
  trial.spent = static_cast<double>(r.evaluations);
  const double unit = scale.unit(is_absolute(r.problem));
  const auto add = [&](double evaluations, double cost) {
    const double gap = (cost - scale.best()) / unit;
    if (std::isfinite(gap) && (trial.steps.empty() || gap < trial.steps.back().second))
      trial.steps.emplace_back(evaluations, gap);
  };
  for (const TracePoint& p : r.trace) add(static_cast<double>(p.evaluations), p.cost);
  if (r.cost) add(trial.spent, *r.cost);
  return trial;
}

// Numbers of names, in order of first appearance.
class Places {
 public:
  std::size_t of(const std::string& name) { return places_.emplace(name, places_.size()).first->second; }

 private:
  std::unordered_map<std::string, std::size_t> places_;
};

bool counts(const RunRecord& r) {
  return r.kind == "run" && !r.trace.empty();
}

void drop_lonely(TrialTable& table) {
  std::erase_if(table.problems, [](const ProblemTrials& p) {
    return std::count_if(p.of.begin(), p.of.end(), [](const auto& trials) { return !trials.empty(); }) < 2;
  });
}

}  // namespace

std::optional<double> Trial::evaluations_to(double precision) const {
  const auto reached = std::partition_point(steps.begin(), steps.end(),
                                            [&](const auto& step) { return step.second > precision; });
  return reached == steps.end() ? std::nullopt : std::optional(reached->first);
}

std::string without_instance(const std::string& problem) {
  const std::size_t at = problem.find("instance=");
  if (at == std::string::npos || at == 0 || problem.back() != ']') return problem;
  const std::size_t end = std::min(problem.find(',', at), problem.size() - 1);
  if (problem[at - 1] == '[' && problem[end] == ']') return problem.substr(0, at - 1);
  const std::size_t begin = problem[end] == ',' ? at : at - 1, behind = problem[end] == ',' ? end + 1 : end;
  return problem.substr(0, begin) + problem.substr(behind);
}

TrialTable trial_table(const std::vector<RunRecord>& records) {
  TrialTable table;
  std::unordered_map<InstanceKey, Scale> scales;
  Places solvers, problems;
  for (const RunRecord& r : records) {
    if (!counts(r)) continue;
    gather(r, scales[key_of(r)]);
    if (solvers.of(r.label) == table.solvers.size()) table.solvers.push_back(r.label);
  }
  for (const RunRecord& r : records) {
    if (!counts(r)) continue;
    const std::string name = without_instance(r.problem);
    // Boxes of instances differ as their optima do; a data set in another box is another problem.
    const std::string key = r.dataset.empty() ? name : key_of(r);
    const std::size_t place = problems.of(key);
    if (place == table.problems.size())
      table.problems.push_back({r.dataset.empty() ? name : name + ", " + r.dataset, is_absolute(r.problem),
                                std::max<std::size_t>(1, r.parameters.size()),
                                std::vector<std::vector<Trial>>(table.solvers.size())});
    table.problems[place].of[solvers.of(r.label)].push_back(trial_of(r, scales[key_of(r)]));
  }
  drop_lonely(table);
  return table;
}

}  // namespace odobench
