// A matrix of runs whose results are kept in a store: the study behind `bench campaign`.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/catalogue/catalogue.hpp"
#include "bench/studies/campaign/campaign_plan.hpp"
#include "bench/studies/campaign/isolation.hpp"
#include "bench/studies/watcher.hpp"

namespace odobench {

struct CampaignStudy {
  std::string file;   // of the campaign
  std::string store;  // SQLite file, made where it is not there
  Shard shard;
  std::string
      only;  // cells to run although they are there: pattern of names, or the begin of a key; "": none
  bool plan_only = false;  // nothing runs, nothing is written
  int threads = 0;         // 0: one per core
  std::optional<InstructionSet> kernel;
  std::optional<IsolationLimits> isolate;
  std::chrono::milliseconds patience{0};  // for another process that writes to the store
};

struct CampaignRow {
  std::string label;
  std::size_t planned = 0, kept = 0, run = 0, failed = 0;
};

struct CampaignSummary {
  std::string name, plan;  // plan: CampaignPlan::check_sum()
  std::size_t problems = 0;
  std::size_t planned = 0;  // cells of the shard, or of --only
  std::size_t kept = 0;     // of these were there
  std::size_t run = 0;      // have run now
  std::size_t failed = 0;   // of these failed
  bool interrupted = false;
  double seconds = 0;             // of running
  std::vector<CampaignRow> rows;  // by label, in the order of the plan
  struct Cell {
    std::string name, key;
    bool there = false;
  };
  std::vector<Cell> cells;  // with plan_only

  std::size_t left() const { return planned - kept - run; }
};

// Runs the cells that are missing in the store, `threads` at a time; results do not depend on it. Every
// record is durable before its cell is reported. Calibrations also get a record of their nominal parameters.
// After a stop those that run are dropped. Throws std::invalid_argument on a store that cannot be written,
// that another process writes to, or of another campaign, DataError on a bad campaign, data set or store,
// and when the disc is full: what is in the store then stays.
CampaignSummary run_campaign(const CampaignStudy& study, const Catalogue& catalogue, Watcher& watcher,
                             const Stop& stop);

}  // namespace odobench
