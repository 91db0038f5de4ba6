// Parameter sets judged on new drives that are steered by them: the study behind `bench verify`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/studies/watcher.hpp"
#include "problems/instruction_set.hpp"
#include "reports/kinds/verification/verification_tables.hpp"
#include "reports/records/record.hpp"

namespace odobench {

struct VerificationStudy {
  std::string scenario;                 // file or name; "": of a robot
  std::string robot;                    // file or class, where there is no scenario
  std::string truth;                    // of a robot, name or file; "": the first of `parameters`
  std::vector<std::string> parameters;  // files or names, comma lists; "nominal" is always the first
  int repeat = 10;                      // times that all drives are driven
  std::uint64_t seed = 1;               // of the noise
  int threads = 0;                      // 0: one per core; results do not depend on them
  std::optional<InstructionSet> kernel;
};

struct Verification {
  VerificationRounds rounds;  // what tables with intervals are made of
  // One per set: the errors of every drive of every repeat, and where the robot really ended.
  std::vector<RunRecord> records;
};

// Every repeat has noise of its own, the same for all sets. Throws std::invalid_argument on unknown names, an
// open-loop scenario and too much work, DataError on a bad file, Interruption when it is to stop.
Verification verify_parameters(const VerificationStudy& study, Watcher& watcher, const Stop& stop);

}  // namespace odobench
