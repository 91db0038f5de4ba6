// Drives that decide between two models, for the user's recordings: `bench plan --between`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/range.hpp"
#include "base/text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/planning/drive_plan.hpp"
#include "bench/studies/planning/rival_models.hpp"
#include "bench/studies/planning/rival_record.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/trust/models_study.hpp"
#include "reports/kinds/planning/planning_tables.hpp"
#include "reports/kinds/planning/rival_tables.hpp"

namespace odobench {
namespace {

ModelFits named_model(const std::string& text) {
  ModelFits fits;
  fits.label = text.empty() ? "plain" : text;
  fits.terms = model_of_text(fits.label == "plain" ? "" : text);
  return fits;
}

}  // namespace

void put_rivals(const ModelFits& a, const ModelFits& b, const RivalPlan& plan, RunRecord& record) {
  record.notes.push_back(fmt::format("{}{} | {}", kRivalsNote, a.label, b.label));
  record.measures.put({"rival_cost.first", a.cost, ""});
  record.measures.put({"rival_cost.second", b.cost, ""});
  if (!plan.unknown.empty())
    record.notes.push_back(fmt::format(
        "Left out, since a factor on drives on the spot says nothing of those that are partly so: {}",
        fmt::join(plan.unknown, ", ")));
  for (const RivalDrive& d : plan.drives)
    if (d.recorded && d.repetitions) {
      record.notes.push_back(
          fmt::format("Drives that were recorded ({}) tell the two apart already: J speaks for {}", d.name,
                      a.cost < b.cost ? a.label : b.label));
      break;
    }
  for (const RivalDrive& d : plan.drives) {
    record.notes.push_back(fmt::format("{}{} | {}", kRivalDriveNote, d.name, d.description));
    const Discrimination& x = d.discrimination;
    for (int k = 0; k < 3; ++k) {
      record.series["rival_difference"].push_back(x.difference[k]);
      record.series["rival_scatter"].push_back(std::sqrt(x.scatter(k, k)));
    }
    const double separation = x.separation(1);
    record.series["rival_separation"].push_back(separation);
    record.series["rival_evidence"].push_back(separation * separation / 2);
    record.series["rival_repetitions"].push_back(d.repetitions ? *d.repetitions : kNotANumber);
    record.series["rival_seconds"].push_back(d.seconds);
  }
}

std::vector<RunRecord> plan_between(const DrivePlan& study, InstructionSet kernel, Watcher& watcher,
                                    const Stop& stop) {
  const std::vector<std::string> names = comma_items(study.between);
  if (names.size() != 2)
    throw std::invalid_argument(fmt::format(
        "--between: found {} model{}, expected two with a comma between, e.g. plain,contact_offset",
        names.size(), names.size() == 1 ? "" : "s"));
  ModelFits a = named_model(names[0]), b = named_model(names[1]);
  if (a.terms == b.terms)
    throw std::invalid_argument(fmt::format("--between: '{}' and '{}' are one model", a.label, b.label));
  CalibrationChoice choice = screened();
  choice.model.emplace();
  const LoadedProblem loaded = load_calibration(study.robot, kernel, choice);
  for (const std::string& said : loaded.left_out) watcher.note(said);
  const Robot& robot = loaded.dataset->robot;
  const CalibrationProblem& plain = *loaded.calibration;
  for (const ModelFits* one : {&a, &b}) {  // refused before anything is fitted
    const std::string& kind = one->terms.speed_factor_of;
    if (std::none_of(plain.recordings().begin(), plain.recordings().end(),
                     [&](const Recording& r) { return r.trajectory.rfind(kind, 0) == 0; }))
      throw std::invalid_argument(
          fmt::format("--between: speed_factor:{}: no trajectory of the recordings begins so", shown(kind)));
    CalibrationOptions options = plain.options();
    options.model = one->terms;
    CalibrationProblem(robot, {plain.recordings().begin(), plain.recordings().end()}, options, kernel);
  }
  RivalPlan plan;
  std::vector<ModelFits*> fits = {&a, &b};
  parallel_for(
      fits.size(), study.threads, [&](std::size_t i) { fit_model(plain, robot, {}, {}, stop, *fits[i]); },
      stop);
  try {
    plan = plan_rivals(plain, robot, a, b, study.threads, stop);
  } catch (const std::invalid_argument& error) {
    throw DataError(fmt::format("{}: {}", study.robot, error.what()));
  }
  if (!plan.refused.empty()) throw DataError(fmt::format("{}: {}", study.robot, plan.refused));
  RunRecord record = study_record(kPlanningProblem, loaded.dataset_name(), "between", plain.parameters(),
                                  loaded.problem.start(), run_context(1, kernel));
  record.dataset_sha256 = loaded.dataset_sha256;
  record.message = "drives that decide between two models";
  put_rivals(a, b, plan, record);
  return {record};
}

}  // namespace odobench
