// Logs of a simulated robot from a scenario: the study behind `bench simulate --scenario`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/studies/watcher.hpp"
#include "datasets/dataset.hpp"

namespace odobench {

struct ScenarioStudy {
  std::string scenario;       // file, or the name of a known one
  std::filesystem::path out;  // folder
  std::uint64_t seed = 1;
  int threads = 0;            // 0: one per core
  bool raw = false;           // the published CSV format instead of a data set; scenarios of recordings
  bool as_published = false;  // the motor robot without the corrections; scenarios of dynamics
  bool overwrite = false;
};

struct WrittenScenario {
  std::vector<std::filesystem::path> files;
  std::optional<Dataset> dataset;  // of a scenario of recordings
};

// Simulates and writes: set.json or raw files with truth.json and truth.csv, or sensors, truth and states of
// the motor robot. Throws std::invalid_argument on options that the scenario does not take, on too much work
// and on files that are there; DataError on a bad scenario; nothing is written then.
WrittenScenario simulate_scenario(const ScenarioStudy& study, Watcher& watcher, const Stop& stop);

}  // namespace odobench
