// Losses, weights and recordings left out, as the command line says and the data decide.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/catalogue/problem_factory.hpp"

namespace odobench {

// Throws std::invalid_argument "--loss-scale: ..." for what contradicts itself.
void require_consistent(const CalibrationChoice& choice);

// Where runs begin that are not told otherwise. Empty: at the nominal parameters.
struct LossStart {
  std::string name;  // "squared": the least-squares solution, "cauchy": that of the Cauchy loss
  Vector z;
};

// Puts what is to be estimated into `options`: with --weights=auto the weights 1 / sp^2 and 1 / st^2 of the
// errors at the least-squares solution with these weights, until they stay or eight times; for a loss without
// given scales those at the least-squares solution of the same data (problems/trust/error_scales.hpp). All
// with four digits. Tukey's loss starts from the Cauchy solution, the others from that of least squares; the
// squared loss from nominal. Throws std::invalid_argument where an estimate is 0.
LossStart fit_loss(const Robot& robot, const std::vector<Recording>& recordings, CalibrationOptions& options,
                   const CalibrationChoice& choice, InstructionSet kernel);

// What differs from its siblings by more than choice.screen is taken out of `recordings`: with a sentence for
// people each.
struct LeftOut {
  std::vector<SetAside> recordings;
  std::vector<std::string> said;
};
LeftOut leave_out(const Robot& robot, std::vector<Recording>& recordings, const CalibrationOptions& options,
                  const CalibrationChoice& choice);

// "line_y_2 differs from its siblings (17 times the usual)" of every recording that does.
std::vector<std::string> unlike_siblings(const std::vector<Recording>& recordings, const Screening& found);

}  // namespace odobench
