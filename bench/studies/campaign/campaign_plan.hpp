// The cells of a campaign: what runs, from where, with which budget, and the key of its result.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bench/studies/campaign/campaign_file.hpp"
#include "bench/studies/cells.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// Every n-th cell of a plan, from the i-th on: "2/4".
struct Shard {
  int number = 1, of = 1;
  bool whole() const { return of == 1; }
  std::string text() const;  // "" of the whole
};

// Throws std::invalid_argument "OPTION=x: expected i/n with 1 <= i <= n".
Shard parse_shard(const std::string& option, const std::string& text);

class CampaignPlan {
 public:
  // Loads every problem. The catalogue outlives the plan. Throws DataError on a bad data set and on a
  // campaign of no cell or of more than kMostRuns.
  CampaignPlan(Campaign campaign, const Catalogue& catalogue, const RunContext& context,
               std::vector<std::string>& notes);

  const Campaign& campaign() const { return campaign_; }
  const std::vector<LoadedProblem>& problems() const { return problems_; }
  const RunContext& context() const { return context_; }
  std::size_t size() const { return cells_.size(); }

  RunCell cell(std::size_t index) const;
  // Of a cell: evaluations of its problem's dimension, and the cost at which it may end.
  Budget budget(std::size_t index) const;
  const LoadedProblem& problem(std::size_t index) const;
  // Of the record: "pso[swarm=60]+lm", with the budget behind it where there are several.
  std::string label(std::size_t index) const;
  // "nist:Misra1a/lm/3", "calibration@demo/pso[swarm=60]/1": what --only compares.
  std::string name(std::size_t index) const;
  bool matches(std::size_t index, const std::string& pattern) const;
  const std::vector<std::string>& keys() const { return keys_; }
  // SHA-256 of all keys.
  const std::string& check_sum() const { return check_sum_; }

  // The record of a result; of one that went another way than planned std::logic_error.
  RunRecord record(std::size_t index, const Result& result, const std::string& time_utc) const;

 private:
  struct Block {
    CellList cells;
    std::size_t budget = 0;
  };
  struct Place {
    std::uint32_t block = 0, cell = 0;
  };
  void load(const Catalogue& catalogue, std::vector<std::string>& notes);
  void list_cells(const Catalogue& catalogue, std::vector<std::string>& notes);
  Budget budget(const Block& block, std::size_t problem) const;
  RunRecord planned(std::size_t index, const RunCell& cell, const OptionValues& options) const;

  Campaign campaign_;
  RunContext context_;
  std::vector<LoadedProblem> problems_;
  std::vector<Block> blocks_;
  std::vector<Place> cells_;
  std::vector<std::string> keys_;
  std::string check_sum_;
};

}  // namespace odobench
