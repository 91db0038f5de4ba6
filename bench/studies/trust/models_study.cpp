#include "bench/studies/trust/models_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/trust/model_fits.hpp"
#include "bench/studies/trust/model_readings.hpp"
#include "bench/studies/trust/validation.hpp"
#include "problems/inspection/inspect.hpp"
#include "reports/kinds/trust/models_tables.hpp"

namespace odobench {
namespace {

std::vector<std::string> split_model(const std::string& text) {
  std::vector<std::string> names;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('+', begin), text.size());
    names.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return names;
}

RunRecord record_of(const ModelFits& fits, const LoadedProblem& loaded, const RunContext& context) {
  RunRecord r =
      study_record(kModelsProblem, loaded.dataset_name(), fits.label, fits.parameters, fits.z, context);
  r.dataset_sha256 = loaded.dataset_sha256;
  r.cost = fits.cost;
  r.evaluations = fits.evaluations;
  for (const MaxErrors& e : fits.errors)
    r.errors.push_back({e.recording, e.trajectory, e.repetition, {e.x, e.y, e.theta}});
  const auto put = [&](const char* name, double value, const char* unit, Better better) {
    r.measures.put({name, value, unit, better});
  };
  put("total", error_total(fits.errors), "m + rad", Better::Lower);
  put("free", fits.free, "", Better::None);
  put("on_bounds", fits.on_bounds, "", Better::None);
  if (!fits.repetitions.empty()) {
    put("held_total", error_total(fits.held_errors), "m + rad", Better::Lower);
    put("held_cost", fits.held_cost, "", Better::Lower);
  }
  if (!fits.trajectories.empty()) {
    put("new_kind_total", error_total(fits.new_kind_errors), "m + rad", Better::Lower);
    put("new_kind_cost", fits.new_kind_cost, "", Better::Lower);
  }
  // Residuals of one recording are worth about six that are independent.
  const double effective = 6 * static_cast<double>(fits.errors.size());
  put("bic", effective * std::log(fits.cost / effective) + fits.free * std::log(effective), "",
      Better::Lower);
  if (fits.terms.held_time_offset != 0) put("lag", fits.terms.held_time_offset, "s", Better::None);
  for (std::size_t p = fits.own; p < fits.parameters.size(); ++p) {
    std::vector<double>& values = r.series["offsets." + fits.parameters[p].name];
    for (const auto* list : {&fits.repetitions, &fits.trajectories})
      for (const FoldFit& fold : *list) values.push_back(fold.z[static_cast<Eigen::Index>(p)]);
  }
  return r;
}

RunRecord nominal_record(const LoadedProblem& loaded, const RunContext& context) {
  const CalibrationProblem& problem = *loaded.calibration;
  RunRecord r = study_record(kModelsProblem, loaded.dataset_name(), "nominal", problem.parameters(),
                             loaded.problem.start(), context);
  r.dataset_sha256 = loaded.dataset_sha256;
  r.cost = problem.cost(loaded.problem.start());
  const std::vector<MaxErrors> errors = problem.max_errors(loaded.problem.start());
  for (const MaxErrors& e : errors)
    r.errors.push_back({e.recording, e.trajectory, e.repetition, {e.x, e.y, e.theta}});
  for (const char* name : {"total", "held_total", "new_kind_total"})
    r.measures.put({name, error_total(errors), "m + rad", Better::Lower});
  return r;
}

}  // namespace

ModelTerms model_of_text(const std::string& text) {
  return model_terms(split_model(text));
}

double measured_lag(const LoadedProblem& loaded, int threads) {
  try {
    for (const inspection::Finding& f :
         inspection::inspect(loaded.dataset->robot, loaded.calibration->recordings(), threads))
      if (f.kind == "reference_lag" && f.figures.count("lowest") == 0)
        return std::round(1000 * f.figures.at("lag")) / 1000;
  } catch (const std::invalid_argument&) {
  } catch (const DataError&) {
  }
  return 0;
}

std::string turning_kind(const std::vector<Recording>& recordings) {
  std::set<std::string> turning, others;
  for (const Recording& r : recordings) {
    const Reference& ref = r.reference;
    double path = 0, turned = 0;
    for (std::size_t k = 1; k < ref.x.size(); ++k) {
      path = std::max(path, std::hypot(ref.x[k] - ref.x[0], ref.y[k] - ref.y[0]));
      turned = std::max(turned, std::abs(ref.theta[k] - ref.theta[0]));
    }
    (turned > 1 && path < 0.05 * turned ? turning : others).insert(r.trajectory);
  }
  if (turning.empty() || others.empty()) return "";
  const std::string& first = *turning.begin();
  const std::string common = first.substr(0, first.find('_'));
  const auto begins = [&](const std::string& name) { return name.rfind(common, 0) == 0; };
  if (std::all_of(turning.begin(), turning.end(), begins) &&
      std::none_of(others.begin(), others.end(), begins))
    return common;
  return others.count(first) == 0 ? first : "";
}

std::vector<std::string> suitable_models(const CalibrationProblem& plain, const Robot& robot, double lag) {
  const bool mean = robot.table.rule == TwistRule::Mean;
  const std::string ls = mean ? "least_squares+" : "",
                    late = lag == 0 ? "" : fmt::format("time_offset={}", lag);
  std::vector<std::string> wanted = {""};
  if (mean) wanted.emplace_back("least_squares");
  for (const char* name : {"contact_offset", "contact_offset+no_steering_rate", "contact_offsets",
                           "contact_offsets+no_steering_rate", "steering_zeros:0.035", "mount", "start_pose",
                           "contact_offset+start_pose", "fixed_layout+contact_offset",
                           "layout_scale+contact_offset", "layout_scale"})
    wanted.push_back(ls + name);
  if (!mean && std::none_of(robot.table.wheels.begin(), robot.table.wheels.end(), is_steered))
    wanted.insert(wanted.end(), {"lever_arm", "heading_offset"});
  if (!late.empty()) {
    wanted.push_back(late + ":speeds");
    for (const char* name : {"contact_offset", "contact_offsets", "contact_offsets+lever_arm"})
      wanted.push_back(ls + name + "+" + late + ":speeds");
    wanted.push_back(late);
    wanted.push_back(ls + "contact_offset+" + late);
  }
  const std::string kind = turning_kind(plain.recordings());
  if (!kind.empty()) wanted.push_back("speed_factor:" + kind);
  std::vector<std::string> list;
  const std::vector<Recording> one = {plain.recordings().front()};
  for (const std::string& text : wanted) {
    CalibrationOptions options = plain.options();
    try {
      options.model = model_of_text(text);
      if (options.mount && (options.model.mount || options.model.lever_arm || options.model.heading_offset))
        continue;
      CalibrationProblem(robot, one, options, plain.kernel());
      list.push_back(text);
    } catch (const std::invalid_argument&) {  // nothing for it to act on
    }
  }
  return list;
}

std::vector<RunRecord> compare_models(const ModelsStudy& study, Watcher& watcher, const Stop& stop) {
  const InstructionSet kernel = kernel_in_force(study.kernel);
  CalibrationChoice choice = study.calibration;
  choice.model.emplace();
  const LoadedProblem loaded = load_calibration(study.data, kernel, choice);
  for (const std::string& remark : loaded.remarks) watcher.warn(remark);
  Robot robot = loaded.dataset->robot;
  if (choice.twist) robot.table.rule = *choice.twist;
  const CalibrationProblem& plain = *loaded.calibration;
  const double lag = measured_lag(loaded, study.threads);
  std::vector<std::string> models = study.models;
  if (models.empty()) models = suitable_models(plain, robot, lag);
  const std::vector<DriveName> drives = drive_names(plain.recordings());
  const std::vector<Fold> repetitions = leave_one_repetition_out(drives).folds,
                          trajectories = leave_one_trajectory_out(drives).folds;
  std::vector<ModelFits> fits(models.size());
  for (std::size_t i = 0; i < models.size(); ++i) {  // refused before anything is fitted
    fits[i].terms = model_of_text(models[i]);
    fits[i].label = models[i].empty() ? "plain" : models[i];
    CalibrationOptions options = plain.options();
    options.model = fits[i].terms;
    with_model(robot, options.model);
  }
  watcher.count_begins("models", static_cast<std::int64_t>(models.size()));
  parallel_for(
      models.size(), study.threads,
      [&](std::size_t i) {
        fit_model(plain, robot, repetitions, trajectories, stop, fits[i]);
        watcher.count_one();
      },
      stop);
  watcher.count_ends();
  const RunContext context = run_context(1, kernel);
  std::vector<RunRecord> records = {nominal_record(loaded, context)};
  for (const ModelFits& one : fits) records.push_back(record_of(one, loaded, context));
  read_models(fits, lag, records);
  return records;
}

}  // namespace odobench
