// Whole data sets of simulated drives.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/dataset.hpp"
#include "problems/simulation/recording_simulator.hpp"
#include "problems/simulation/scenario.hpp"

namespace odobench::simulate {

// One drive with what made it. Exact drives have no logs.
struct SimulatedDrive {
  Recording recording;
  DriveLogs logs;
  std::int64_t log_time_us = 0;  // of the recording's time 0, on the clock of the logs
};

struct SimulatedSet {
  Dataset dataset;  // knows the true parameters as "truth", the believed ones as "believed"
  std::vector<SimulatedDrive> drives;  // of each recording, in order; recordings are in the data set only
};

// Drive by drive, repetition by repetition. The seed of each derives from `seed`, the drive's name and the
// repetition: the same bits alone, among others and for any number of threads (0: as many as the machine
// has). Throws DataError when the scenario is not valid.
SimulatedSet simulate_set(const RecordingScenario& scenario, std::uint64_t seed, int threads = 0);

// One of them. The scenario must be valid.
SimulatedDrive simulate_drive(const RecordingScenario& scenario, const Drive& drive, int repetition,
                              std::uint64_t seed);

// "truth" and "believed".
std::vector<NamedParameters> known_parameters(const RecordingScenario& scenario);

// truth.json: the scenario's name, the seed, true parameters, kinematics, offsets and slip; of each recording
// when the drive began and ended, on the recording's clock.
std::string truth_json(const RecordingScenario& scenario, std::uint64_t seed, const SimulatedSet& set);
// truth.csv: recording,time_s,x,y,theta, the true path every tenth of a second on the recording's clock.
std::string truth_csv(const RecordingScenario& scenario, const SimulatedSet& set);

}  // namespace odobench::simulate
