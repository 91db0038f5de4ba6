// Which parameters a set of drives can determine, before anybody drives them.
//
// With relative parameters q = z / |nominal|, H = J'J of a drive's residuals at the true parameters and g =
// J'r of the residuals r that its noise leaves there, calibrating from the drives d = 1..D, driven n_d times
// each, gives
//     q - q_true = A^-1 G,   A = sum n_d H_d,   cov(q) = A^-1 C A^-1,
//     C = sum n_d V_d + m m',   m = sum n_d b_d,   b_d = mean of g,   V_d = its covariance
// (linear theory of the unweighted least squares that a calibration minimises; bounds ignored). V and b come
// from replicas of the drive with other noise, so that everything the sensors do is in them: capture noise,
// jitter, lost messages, quanta, a start pose that is not quite zero, and what no parameters explain.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "datasets/recording.hpp"
#include "problems/calibration/calibration_problem.hpp"

namespace odobench {

struct DriveInformation {
  std::string name;
  Matrix normal;   // H, mean over the replicas (n x n)
  Vector bias;     // b (n)
  Matrix scatter;  // V (n x n)
};

// From at least two replicas of one drive. `truth`: the parameters they were made with. Throws
// std::invalid_argument.
DriveInformation drive_information(const std::string& name, const std::vector<ParameterInfo>& parameters,
                                   const std::vector<Recording>& replicas, const Vector& truth,
                                   InstructionSet kernel = widest_instruction_set());
// The same for any robot and cost: parameters that are held fixed (lower = upper) are left out, so that there
// are as many as free_parameters() has. `truth`: all of them.
DriveInformation drive_information(const std::string& name, const Robot& robot,
                                   const CalibrationOptions& options, const std::vector<Recording>& replicas,
                                   const Vector& truth, InstructionSet kernel = widest_instruction_set());
std::vector<ParameterInfo> free_parameters(const Robot& robot);

// What recordings tell that were made already, by trajectory in the order of `names`. `fit`: the parameters
// at which they are explained best. V is the mean of g g' over the recordings of a trajectory, times R / (R -
// 1) of all R recordings, and b = 0, since G vanishes at the fit; with fewer than two more recordings than
// parameters V would have gaps, and is sigma^2 H with sigma^2 = J / (residuals - parameters) instead, which
// takes all residuals as independent and is too sure.
struct RecordedInformation {
  std::vector<DriveInformation> drives;
  bool by_recording = true;
};
RecordedInformation recorded_information(const std::vector<std::string>& names, const Robot& robot,
                                         const CalibrationOptions& options,
                                         const std::vector<Recording>& recordings, const Vector& fit,
                                         InstructionSet kernel = widest_instruction_set());

// From one recording without noise, as if every pose component had white noise of this standard deviation (m,
// rad).
DriveInformation ideal_information(const std::string& name, const std::vector<ParameterInfo>& parameters,
                                   const Recording& recording, const Vector& truth, double sigma,
                                   InstructionSet kernel = widest_instruction_set());

// A combination of parameters.
struct Direction {
  double singular_value = 0;  // of the noise-weighted Jacobian in q: 1 / standard_deviation; 0 when invisible
  double standard_deviation = 0;  // relative, along the unit vector; infinite when invisible
  Vector vector;                  // unit vector in q
};

struct PlanAnalysis {
  Vector standard_deviations;         // relative, of each parameter; infinite when undetermined
  std::vector<Direction> directions;  // best determined first
  // A basis of the directions whose standard deviation exceeds `wanted`, with as few parameters in each as
  // elimination finds, largest entry 1, in q (n x count).
  Matrix undetermined;
  std::vector<std::string> undetermined_words;  // the same: "a1 against a2": one larger in size, the other
  // smaller changes nothing
};

// `counts`: how often each drive is driven (not negative). Throws std::invalid_argument when the lengths
// differ.
PlanAnalysis analyse_drives(std::span<const DriveInformation> drives, const std::vector<int>& counts,
                            const std::vector<ParameterInfo>& parameters, double wanted);

// One step of a proposal: the drive added and the largest standard deviation after it.
struct Proposal {
  std::size_t drive = 0;
  double largest_deviation = 0;
};

// `fixed`: what else is driven, as one sum (empty matrices: nothing).
// Adds one drive after the other to `counts`, each time the one that lowers sum_i max(0, log(sd_i / wanted))
// most (a parameter nothing tells about counts as known to its box), until every standard deviation is at
// most `wanted` or `most` drives have been added.
std::vector<Proposal> propose_drives(std::span<const DriveInformation> drives, std::vector<int> counts,
                                     const DriveInformation& fixed,
                                     const std::vector<ParameterInfo>& parameters, double wanted, int most);

}  // namespace odobench
