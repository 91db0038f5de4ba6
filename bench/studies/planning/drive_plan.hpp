// Which parameters drives can determine, and which drives to add: the study behind `bench plan`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/studies/watcher.hpp"
#include "problems/instruction_set.hpp"
#include "reports/records/record.hpp"

namespace odobench {

struct DrivePlan {
  std::string robot;                    // scenario: file or name
  std::vector<std::string> drives;      // comma lists, or "none"; empty: those of the scenario
  std::vector<std::string> candidates;  // comma lists to choose from, or "all"; empty: no proposals
  // Two models, names combined by '+', "plain" for none: which drives decide between them. Empty: not asked.
  std::vector<std::string> between;
  double wanted = 0.005;   // relative standard deviation of every parameter
  int replicas = 32;       // fewer miss the rare late messages that decide
  std::uint64_t seed = 1;  // of the noise
  int threads = 0;         // 0: one per core; results do not depend on them
  std::optional<InstructionSet> kernel;
};

// One record: the relative standard deviations and directions of the plan (what is not determined has no
// measure), and drives proposed one after the other until all are `wanted`. The drives' noise is taken from
// `replicas` simulations of each. Throws std::invalid_argument on unknown names and on too much work,
// DataError on a bad scenario, Interruption when it is to stop.
std::vector<RunRecord> plan_drives(const DrivePlan& study, Watcher& watcher, const Stop& stop);

// With study.between: one record of reports/kinds/planning/rival_tables.hpp. study.robot is a set of
// recordings, to which both models are fitted. Throws as above, DataError where the noise of the recordings
// cannot be told.
std::vector<RunRecord> plan_between(const DrivePlan& study, InstructionSet kernel, Watcher& watcher,
                                    const Stop& stop);

}  // namespace odobench
