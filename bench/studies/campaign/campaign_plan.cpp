#include "bench/studies/campaign/campaign_plan.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <unordered_set>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/text.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/studies/records.hpp"
#include "reports/records/record_key.hpp"

namespace odobench {
namespace {

constexpr int kMostShards = 100'000;

// Solvers, repetitions, polishes and budgets of one problem, before any is left out.
std::size_t cells_of_problem(const Campaign& campaign) {
  return campaign.solvers.size() * campaign.polishes.size() * campaign.budgets.size() *
         static_cast<std::size_t>(campaign.repeat);
}

}  // namespace

std::string Shard::text() const {
  return whole() ? "" : fmt::format("{}/{}", number, of);
}

Shard parse_shard(const std::string& option, const std::string& text) {
  const auto slash = text.find('/');
  try {
    if (slash == std::string::npos) throw std::invalid_argument("");
    Shard shard;
    shard.of = static_cast<int>(whole_number(option, text.substr(slash + 1), 1, kMostShards));
    shard.number = static_cast<int>(whole_number(option, text.substr(0, slash), 1, shard.of));
    return shard;
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(fmt::format("{}={}: expected i/n with 1 <= i <= n <= {}, such as 2/4", option,
                                            shown(text), kMostShards));
  }
}

CampaignPlan::CampaignPlan(Campaign campaign, const Catalogue& catalogue, const RunContext& context,
                           std::vector<std::string>& notes)
    : campaign_(std::move(campaign)), context_(context) {
  const std::size_t most = cells_of_problem(campaign_) * campaign_.problems.size();
  if (most > kMostRuns)
    throw DataError(
        fmt::format("campaign '{}': found {} cells ({} solvers, {} polishes, {} problems, {} budgets, {} "
                    "repetitions), expected at most {}: several campaigns, each with a store of its own",
                    shown(campaign_.name), most, campaign_.solvers.size(), campaign_.polishes.size(),
                    campaign_.problems.size(), campaign_.budgets.size(), campaign_.repeat, kMostRuns));
  load(catalogue, notes);
  list_cells(catalogue, notes);
}

void CampaignPlan::load(const Catalogue& catalogue, std::vector<std::string>& notes) {
  std::vector<CampaignProblem> kept;
  std::unordered_set<std::string> seen;
  for (const CampaignProblem& wanted : campaign_.problems) {
    try {
      LoadedProblem loaded = catalogue.problem(wanted.name).make(wanted.request);
      if (!seen.insert(loaded.name() + "\n" + loaded.dataset_name() + "\n" + loaded.dataset_sha256).second) {
        notes.push_back(fmt::format("problem '{}' is listed more than once and runs once", loaded.name()));
        continue;
      }
      for (const std::string& remark : loaded.remarks) notes.push_back(remark);
      problems_.push_back(std::move(loaded));
      kept.push_back(wanted);
    } catch (const std::invalid_argument& e) {
      throw DataError(wanted.where + e.what());
    }
  }
  campaign_.problems = std::move(kept);
}

void CampaignPlan::list_cells(const Catalogue& catalogue, std::vector<std::string>& notes) {
  std::vector<std::string> repeated;
  for (const SolverSpec& polish : campaign_.polishes)
    for (std::size_t b = 0; b < campaign_.budgets.size(); ++b) {
      Block block{CellList(catalogue), b};
      for (std::size_t k = 0; k < problems_.size(); ++k) {
        CellPlan plan;
        plan.solvers = campaign_.solvers;
        plan.polish = polish;
        plan.repeat = campaign_.repeat;
        plan.base_seed = campaign_.seed;
        plan.random_start = campaign_.random_start;
        plan.problem = problems_[k].name();
        plan.dataset = problems_[k].dataset_name();
        block.cells.add(plan, k, k == 0 && blocks_.empty() ? notes : repeated);
      }
      blocks_.push_back(std::move(block));
    }
  std::map<std::string, OptionValues> options;  // in force, by solver as typed
  std::unordered_set<std::string> seen;         // a solver that is its own polish is there without one
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (std::size_t i = 0; i < blocks_[b].cells.size(); ++i) {
      cells_.push_back({static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(i)});
      const RunCell one = blocks_[b].cells[i];
      const auto [in_force, is_new] = options.try_emplace(one.solver.text());
      if (is_new) catalogue.solver(one.solver.name).make(one.solver.options, &in_force->second);
      std::string key = record_key(planned(cells_.size() - 1, one, in_force->second));
      if (seen.insert(key).second)
        keys_.push_back(std::move(key));
      else
        cells_.pop_back();
    }
  std::string all;
  for (const std::string& key : keys_) all += key;
  check_sum_ = sha256(all);
}

RunCell CampaignPlan::cell(std::size_t index) const {
  return blocks_[cells_[index].block].cells[cells_[index].cell];
}

const LoadedProblem& CampaignPlan::problem(std::size_t index) const {
  return problems_[cell(index).problem];
}

Budget CampaignPlan::budget(const Block& block, std::size_t problem) const {
  const CampaignBudget& wanted = campaign_.budgets[block.budget];
  const Problem& model = problems_[problem].problem;
  Budget budget;
  budget.max_evaluations = wanted.per_parameter > 0
                               ? wanted.per_parameter * static_cast<std::int64_t>(model.parameters().size())
                               : wanted.evaluations;
  budget.max_seconds = wanted.seconds;
  if (campaign_.problems[problem].target)
    budget.target_cost = *campaign_.problems[problem].target;
  else if (const auto known = model.known_optimum(); known && !campaign_.targets.empty())
    budget.target_cost = *known + campaign_.targets.back() * std::max(1.0, std::abs(*known));
  return budget;
}

Budget CampaignPlan::budget(std::size_t index) const {
  return budget(blocks_[cells_[index].block], cell(index).problem);
}

std::string CampaignPlan::label(std::size_t index) const {
  const std::string label = cell(index).label();
  if (campaign_.budgets.size() == 1) return label;
  return fmt::format("{} ({})", label, campaign_.budgets[blocks_[cells_[index].block].budget].text());
}

std::string CampaignPlan::name(std::size_t index) const {
  const LoadedProblem& of = problem(index);
  const std::string set = of.dataset_name();
  return fmt::format("{}{}/{}/{}", of.name(), set.empty() ? "" : "@" + set, label(index),
                     cell(index).repetition);
}

bool CampaignPlan::matches(std::size_t index, const std::string& pattern) const {
  constexpr std::size_t kShortestKey = 8;
  if (pattern.size() >= kShortestKey && keys_[index].rfind(pattern, 0) == 0) return true;
  const std::string name = this->name(index);
  return name == pattern || ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

RunRecord CampaignPlan::planned(std::size_t index, const RunCell& cell, const OptionValues& options) const {
  const Block& block = blocks_[cells_[index].block];
  RunRecord record = planned_record(problems_[cell.problem], cell, options, campaign_.seed,
                                    budget(block, cell.problem), context_, "");
  if (campaign_.budgets.size() > 1)
    record.label += fmt::format(" ({})", campaign_.budgets[block.budget].text());
  return record;
}

RunRecord CampaignPlan::record(std::size_t index, const Result& result, const std::string& time_utc) const {
  const RunCell own = cell(index);
  RunRecord record =
      run_record(problems_[own.problem], own, campaign_.seed, budget(index), result, context_, time_utc);
  record.label = label(index);
  if (record_key(record) != keys_[index])
    throw std::logic_error(fmt::format("the run of the cell {} is not the planned one", name(index)));
  return record;
}

}  // namespace odobench
