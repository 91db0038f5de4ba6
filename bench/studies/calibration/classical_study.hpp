// Classical calibrations beside solvers: rows of their tables, and starts of their runs.
#pragma once

#include <string>
#include <vector>

#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/parameter_sets.hpp"
#include "bench/studies/watcher.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// What --classical, --side and --start say.
struct ClassicalChoice {
  bool wanted = false;  // rows in the tables
  std::vector<std::string>
      names;        // comma lists of methods, "all" of every one; none: those made for the robot
  double side = 0;  // of squares, m; 0: a quarter of the path
};

// Methods as asked for, each once, in the order of the list; of none asked for those made for the class,
// which may be none. Throws std::invalid_argument "--classical=NAME: ..." for an unknown one.
std::vector<std::string> classical_methods(const ClassicalChoice& choice, const std::string& kinematics);

// One record per method, labelled "classical:NAME": J and errors of the parameters that it finds, its figures
// as measures. Kind "evaluation"; "skipped" with the reason as message where it does not apply. A method that
// finds a matrix has J and errors of its poses and no parameters. Those with parameters are appended to
// `sets` unless that is null.
std::vector<RunRecord> classical_records(const LoadedProblem& loaded, const ClassicalChoice& choice,
                                         const RunContext& context, std::vector<ParameterSet>* sets,
                                         Watcher& watcher);

// What a method finds as the start of every solver, moved into the box, which a note then says. Throws
// DataError with the reason where it does not apply, std::invalid_argument for an unknown method and a
// problem that is no calibration.
Vector classical_start(const LoadedProblem& loaded, const std::string& method, const ClassicalChoice& choice,
                       std::vector<std::string>& notes);

// Throws std::invalid_argument "--start=NAME: ..." unless it is nominal, random or a classical method.
void require_start(const std::string& name);

}  // namespace odobench
