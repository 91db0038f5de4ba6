// A filter's noise parameters fitted with any solver: the study behind `bench tune`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/catalogue/catalogue.hpp"
#include "bench/studies/fusion/fusion_runs.hpp"
#include "bench/studies/watcher.hpp"
#include "problems/problem.hpp"
#include "reports/kinds/fusion/tuning_tables.hpp"
#include "reports/records/record.hpp"

namespace odobench {

struct TuningStudy {
  std::string data;  // path of set.json; empty: the demo set
  std::string parameters = "nominal";
  std::string sensors;               // file; its sigmas are the start
  std::vector<std::string> solvers;  // comma lists; empty: nlopt:bobyqa
  std::string filter = "ekf";        // or ukf
  std::string objective = "likelihood";
  std::int64_t max_evaluations = 200;
  std::optional<std::uint64_t> seed;  // instead of the file's
  std::optional<InstructionSet> kernel;
};

struct Tuning {
  TuningCircumstances circumstances;
  Table sensors;                   // which they are
  std::string best_sensors;        // text of a sensors file with the sigmas that cost least
  std::vector<RunRecord> records;  // one per setting, the given one first; alone when no solver gave a result
};

// The first drive of each trajectory trains; the others judge, or the same ones where there are no others.
// Solvers without a result are told as warnings. Throws std::invalid_argument on names that are none,
// DataError on bad files and where a filter breaks down, Interruption when it is to stop.
Tuning tune_filter(const TuningStudy& study, const Catalogue& catalogue, Watcher& watcher, const Stop& stop);

}  // namespace odobench
