#include "bench/studies/calibration/evaluation_study.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "bench/catalogue/loss_choice.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/calibration/stored_parameters.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/inspection/inspection_study.hpp"
#include "bench/studies/records.hpp"
#include "problems/information/identifiability.hpp"

namespace odobench {
namespace {

void require_finite(const RunRecord& record) {
  bool finite = record.cost && std::isfinite(*record.cost);
  for (const RecordingError& e : record.errors)
    for (const double error : e.max_error) finite = finite && std::isfinite(error);
  if (!finite)
    throw DataError(
        fmt::format("parameters '{}' on data set '{}': the cost overflows, expected values of a robot's size",
                    record.label, record.dataset));
}

// What the data do not tell at the first of the parameter sets: before any calibration where that is nominal.
void note_undetermined(Evaluation& evaluation) {
  const ParameterSet& first = evaluation.sets.front();
  const std::string note = identifiability_note(
      evaluation.loaded.problem, identifiability(evaluation.loaded.problem, first.values),
      fmt::format("{}, at {}", evaluation.loaded.dataset_name(), first.label));
  if (!note.empty()) evaluation.records.front().notes.push_back(note);
}

// Recordings that a calibration would leave out.
std::vector<std::string> differing(const LoadedProblem& loaded, double limit, Watcher& watcher) {
  if (!(limit > 0)) return {};
  const std::vector<Recording>& recordings = loaded.calibration->recordings();
  std::vector<std::string> said = unlike_siblings(
      recordings, screen_siblings(loaded.dataset->robot, recordings, loaded.calibration->options(), limit));
  for (const std::string& sentence : said) watcher.warn(sentence);
  return said;
}

}  // namespace

Evaluation evaluate_parameters(const EvaluationStudy& study, Watcher& watcher, const Stop& stop) {
  const InstructionSet kernel = kernel_in_force(study.kernel);
  CalibrationChoice choice = study.calibration;
  choice.screen = 0;
  Evaluation evaluation{load_calibration(study.data, kernel, choice), {}, {}};
  for (const std::string& remark : evaluation.loaded.remarks) watcher.warn(remark);
  evaluation.sets = read_judged_parameters(evaluation.loaded, study.parameters, watcher);
  const RunContext context = run_context(1, kernel);
  for (const ParameterSet& set : evaluation.sets) {
    stop.check();
    evaluation.records.push_back(evaluation_record(evaluation.loaded, set.label, set.values, context));
    require_finite(evaluation.records.back());
  }
  evaluation.records.front().notes = differing(evaluation.loaded, study.calibration.screen, watcher);
  for (std::string& finding : say_findings(evaluation.loaded, {}, false, 0, watcher))
    evaluation.records.front().notes.push_back(std::move(finding));
  note_undetermined(evaluation);
  for (RunRecord& record :
       classical_records(evaluation.loaded, study.classical, context, &evaluation.sets, watcher)) {
    if (record.kind == "evaluation") require_finite(record);
    evaluation.records.push_back(std::move(record));
  }
  return evaluation;
}

}  // namespace odobench
