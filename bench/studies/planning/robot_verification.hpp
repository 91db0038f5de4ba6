// Parameter sets judged on new drives of a robot of any class or of a user's own wheels.
#pragma once

#include "bench/studies/parameter_sets.hpp"
#include "bench/studies/planning/verification.hpp"
#include "problems/calibration/calibration_problem.hpp"

namespace odobench {

// Of study.robot: its standard drives, three times per repeat, each steered by the robot's own odometry with
// the set that is judged; the truth is study.truth, else the first of study.parameters. Sets outside the box
// are told. Throws as verify_parameters().
Verification verify_robot(const VerificationStudy& study, InstructionSet kernel, Watcher& watcher,
                          const Stop& stop);

// What both kinds of verification record: one record per set.
struct VerifiedDrives {
  std::string name;
  std::vector<std::string> drives;
  int repetitions = 1;
  std::vector<ParameterInfo> parameters;
};
std::vector<RunRecord> verification_records(const VerifiedDrives& of, const std::vector<ParameterSet>& sets,
                                            const std::vector<std::vector<VerifyOutcome>>& outcomes,
                                            const VerificationStudy& study, InstructionSet kernel);

// Errors of the recordings by these parameters, into the outcome.
void put_errors(const CalibrationProblem& problem, const Vector& believed, VerifyOutcome& outcome);

// "nominal" and every set of --parameters.
std::vector<ParameterSet> verified_sets(const ParameterNames& names, const VerificationStudy& study);

}  // namespace odobench
