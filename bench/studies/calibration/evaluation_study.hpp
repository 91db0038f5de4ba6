// Cost and errors of given parameters: the study behind `bench evaluate`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/calibration/classical_study.hpp"
#include "bench/studies/parameter_sets.hpp"
#include "bench/studies/watcher.hpp"
#include "reports/records/record.hpp"

namespace odobench {

struct EvaluationStudy {
  std::string data;  // path of set.json; empty: the demo set
  // Nothing is left out: what differs from its siblings by more than calibration.screen is a note.
  CalibrationChoice calibration = screened();
  std::vector<std::string> parameters;  // files, names or run directories, as of read_judged_parameters()
  ClassicalChoice classical;            // methods that are evaluated behind them
  std::optional<InstructionSet> kernel;
};

struct Evaluation {
  LoadedProblem loaded;
  std::vector<ParameterSet> sets;
  // One per set and classical method; the first has a note where the data do not determine the parameters.
  std::vector<RunRecord> records;
};

// Throws std::invalid_argument on parameters that are none, DataError on a bad set and where J or an error
// overflows, Interruption when it is to stop.
Evaluation evaluate_parameters(const EvaluationStudy& study, Watcher& watcher, const Stop& stop);

}  // namespace odobench
