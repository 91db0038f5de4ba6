#include "bench/studies/planning/plan_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/names.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/records.hpp"
#include "reports/kinds/planning/planning_tables.hpp"

namespace odobench {
namespace {

constexpr int kMostProposals = 60;

std::size_t index_of(const std::vector<std::string>& names, const std::string& name, const char* option) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return i;
    list += (list.empty() ? "" : ", ") + names[i];
  }
  throw std::invalid_argument(
      fmt::format("{}: unknown drive '{}'{}; known: {}", option, name, did_you_mean(name, names), list));
}

}  // namespace

DriveSelection select_drives(const std::vector<std::string>& names, const std::vector<int>& own,
                             const DrivePlan& study) {
  std::vector<int> counts(names.size(), 0);
  std::vector<bool> candidate(names.size(), false);
  if (study.drives.empty())
    counts = own;
  else if (!(study.drives.size() == 1 && study.drives.front() == "none"))
    for (const std::string& name : comma_items(study.drives)) ++counts[index_of(names, name, "--drives")];
  for (const std::string& name : comma_items(study.candidates)) {
    if (name == "all")
      candidate.assign(names.size(), true);
    else
      candidate[index_of(names, name, "--candidates")] = true;
  }
  DriveSelection selection;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (counts[i] == 0 && !candidate[i]) continue;
    selection.drives.push_back(i);
    selection.counts.push_back(counts[i]);
    selection.candidate.push_back(candidate[i]);
  }
  if (selection.drives.empty())
    throw std::invalid_argument("--drives=none needs --candidates: there is nothing to plan");
  return selection;
}

RunRecord plan_record(const std::string& name, const PlanAnalysis& a,
                      const std::vector<ParameterInfo>& parameters, const DrivePlan& study,
                      InstructionSet kernel) {
  Vector nominal(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < nominal.size(); ++i)
    nominal[i] = parameters[static_cast<std::size_t>(i)].nominal;
  RunRecord record = study_record(kPlanningProblem, name, "plan", parameters, nominal,
                                  run_context(thread_count(study.threads), kernel));
  record.message = "what calibrations on these drives would determine";
  record.seed = record.base_seed = study.seed;
  record.measures.put({"wanted", study.wanted, ""});
  double determined = 0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double deviation = a.standard_deviations[static_cast<Eigen::Index>(i)];
    record.series["standard_deviations"].push_back(deviation);
    if (std::isfinite(deviation))
      record.measures.put(
          {"deviation." + parameters[i].name, deviation, "", Better::None, parameters[i].name});
    determined += deviation <= study.wanted ? 1 : 0;
  }
  record.measures.put({"determined", determined, ""});
  for (const Direction& d : a.directions) {
    record.series["singular_values"].push_back(d.singular_value);
    record.series["direction_deviations"].push_back(d.standard_deviation);
    for (const double part : d.vector) record.series["directions"].push_back(part);
  }
  for (const std::string& words : a.undetermined_words) record.notes.push_back(kUndeterminedNote + words);
  return record;
}

void put_proposals(const std::vector<DriveInformation>& drives, const DriveSelection& selection,
                   const std::vector<ParameterInfo>& parameters, double wanted, RunRecord& record) {
  std::vector<DriveInformation> candidates;
  std::vector<int> counts;
  const auto n = static_cast<Eigen::Index>(parameters.size());
  DriveInformation fixed{"", Matrix::Zero(n, n), Vector::Zero(n), Matrix::Zero(n, n)};
  for (std::size_t i = 0; i < drives.size(); ++i) {
    if (selection.candidate[i]) {
      candidates.push_back(drives[i]);
      counts.push_back(selection.counts[i]);
      continue;
    }
    fixed.normal += selection.counts[i] * drives[i].normal;
    fixed.scatter += selection.counts[i] * drives[i].scatter;
    fixed.bias += selection.counts[i] * drives[i].bias;
  }
  for (const Proposal& p : propose_drives(candidates, counts, fixed, parameters, wanted, kMostProposals)) {
    record.notes.push_back(kProposedNote + candidates[p.drive].name);
    record.series["proposed"].push_back(p.largest_deviation);
  }
}

std::string too_few_replicas(const DriveSelection& selection, std::size_t parameters,
                             const DrivePlan& study) {
  const auto drives = static_cast<std::size_t>(
      std::count_if(selection.counts.begin(), selection.counts.end(), [](int count) { return count > 0; }));
  const std::size_t rank = drives * static_cast<std::size_t>(study.replicas - 1);
  if (drives == 0 || rank >= parameters) return "";
  return fmt::format(
      "--replicas={}: the noise of {} drive{} shows in {} of {} combinations, the others look exactly "
      "determined; "
      "give at least --replicas={}",
      study.replicas, drives, drives == 1 ? "" : "s", rank, parameters,
      (parameters + drives - 1) / drives + 1);
}

}  // namespace odobench
