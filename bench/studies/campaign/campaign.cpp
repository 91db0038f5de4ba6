#include "bench/studies/campaign/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <unordered_set>

#include "base/json_node.hpp"
#include "base/text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/inspection/inspection_study.hpp"
#include "bench/studies/records.hpp"
#include "reports/records/record_key.hpp"
#include "reports/records/record_store.hpp"

namespace odobench {
namespace {

// Cells whose records are stored, on their way to be reported: once the disc has them, which takes long, so
// that one wait serves all that came meanwhile. A thread of its own does it, or where `own_thread` is false
// whoever calls sync().
class Reports {
 public:
  Reports(RecordStore& store, Watcher& watcher, bool own_thread) : store_(store), watcher_(watcher) {
    if (own_thread) thread_ = std::thread([this] { work(); });
  }
  ~Reports() { end(); }
  Reports(const Reports&) = delete;
  Reports& operator=(const Reports&) = delete;

  // Throws what keeping an earlier one threw.
  void add(std::size_t i) {
    {
      const std::lock_guard lock(mutex_);
      if (error_) std::rethrow_exception(error_);
      waiting_.push_back(i);
    }
    news_.notify_one();
  }
  void sync() {
    std::vector<std::size_t> now;
    {
      const std::lock_guard lock(mutex_);
      now.swap(waiting_);
    }
    if (now.empty()) return;
    store_.sync();
    for (const std::size_t i : now) watcher_.finished(i);
  }
  // All are reported.
  void finish() {
    end();
    sync();
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    while (!ended_ && !error_) {
      news_.wait(lock, [this] { return ended_ || !waiting_.empty(); });
      lock.unlock();
      std::exception_ptr error;
      try {
        sync();
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      error_ = error;
    }
  }
  void end() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    news_.notify_one();
    if (thread_.joinable()) thread_.join();
  }

  RecordStore& store_;
  Watcher& watcher_;
  std::mutex mutex_;
  std::condition_variable news_;
  std::vector<std::size_t> waiting_;
  std::exception_ptr error_;
  bool ended_ = false;
  std::thread thread_;
};

// What runs now, and where its records go. From any thread.
class Recorder {
 public:
  Recorder(const CampaignPlan& plan, const std::vector<std::size_t>& which, std::int64_t first_place,
           RecordStore& store, Watcher& watcher, bool own_thread)
      : plan_(plan),
        which_(which),
        first_place_(first_place),
        store_(store),
        watcher_(watcher),
        reports_(store, watcher, own_thread) {}

  void started(std::size_t i) { watcher_.started(i); }
  void progressed(std::size_t i, const Progress& progress) { watcher_.progressed(i, progress); }
  void keep(std::size_t i, const RunRecord& record) {
    const std::size_t cell = which_[i];
    store_.append(plan_.keys()[cell], plan_.campaign().name, first_place_ + static_cast<std::int64_t>(cell),
                  record);
    {
      const std::lock_guard lock(mutex_);
      done_.push_back(cell);
      if (record.termination == to_string(Termination::Failed)) failed_.push_back(cell);
    }
    reports_.add(i);
  }
  void sync() { reports_.sync(); }
  void finish() { reports_.finish(); }
  const std::vector<std::size_t>& done() const { return done_; }
  const std::vector<std::size_t>& failed() const { return failed_; }

 private:
  const CampaignPlan& plan_;
  const std::vector<std::size_t>& which_;
  const std::int64_t first_place_;
  RecordStore& store_;
  Watcher& watcher_;
  std::mutex mutex_;
  std::vector<std::size_t> done_, failed_;
  Reports reports_;
};

// Nothing when it was stopped: a part of a run is no result.
std::optional<RunRecord> run_one(const CampaignPlan& plan, std::size_t cell, int threads, const Stop& stop,
                                 const Catalogue& catalogue, Observer observer) {
  const std::string begin = utc_now();
  const std::optional<Result> result =
      run_cell(plan.problem(cell).problem, plan.cell(cell), plan.budget(cell), threads, stop, catalogue,
               std::move(observer));
  if (!result || result->termination == Termination::Interrupted) return std::nullopt;
  return plan.record(cell, *result, begin);
}

class IsolatedCells final : public IsolatedWork {
 public:
  IsolatedCells(const CampaignPlan& plan, const std::vector<std::size_t>& which, const Catalogue& catalogue,
                const Stop& stop, Recorder& recorder)
      : plan_(plan), which_(which), catalogue_(catalogue), stop_(stop), recorder_(recorder) {}

  std::optional<std::string> run(std::size_t piece) override {
    const std::optional<RunRecord> record = run_one(plan_, which_[piece], 1, stop_, catalogue_, {});
    if (!record) return std::nullopt;
    return to_json_line(*record);
  }
  void started(std::size_t piece) override { recorder_.started(piece); }
  void finished(std::size_t piece, const std::string& bytes) override {
    recorder_.keep(piece, record_from(JsonNode::parse_line(bytes, "record of a child process", 1)));
  }
  void failed(std::size_t piece, const std::string& reason) override {
    const std::size_t cell = which_[piece];
    const SolverSpec solver = plan_.cell(cell).solver;
    Result result;
    result.solver = solver.text();
    catalogue_.solver(solver.name).make(solver.options, &result.options);
    result.termination = Termination::Failed;
    result.message = reason;
    recorder_.keep(piece, plan_.record(cell, result, utc_now()));
  }
  void settled() override { recorder_.sync(); }

 private:
  const CampaignPlan& plan_;
  const std::vector<std::size_t>& which_;
  const Catalogue& catalogue_;
  const Stop& stop_;
  Recorder& recorder_;
};

// The cells of the shard, or those of it that --only names.
std::vector<std::size_t> chosen_cells(const CampaignStudy& study, const CampaignPlan& plan) {
  std::vector<std::size_t> chosen;
  const auto step = static_cast<std::size_t>(study.shard.of);
  for (auto i = static_cast<std::size_t>(study.shard.number - 1); i < plan.size(); i += step)
    if (study.only.empty() || plan.matches(i, study.only)) chosen.push_back(i);
  if (chosen.empty() && !study.only.empty())
    throw std::invalid_argument(
        fmt::format("--only={}: no cell{} is called so; --dry-run --format=csv lists all, such as '{}'",
                    shown(study.only), study.shard.whole() ? "" : " of shard " + study.shard.text(),
                    plan.size() > 0 ? plan.name(0) : ""));
  return chosen;
}

CampaignSummary summary_of(const CampaignPlan& plan, const std::vector<std::size_t>& chosen,
                           const std::vector<std::size_t>& missing) {
  CampaignSummary summary;
  summary.name = plan.campaign().name;
  summary.plan = plan.check_sum();
  summary.problems = plan.problems().size();
  summary.planned = chosen.size();
  summary.kept = chosen.size() - missing.size();
  std::map<std::string, std::size_t> rows;
  const auto row_of = [&](std::size_t cell) -> CampaignRow& {
    const std::string label = plan.label(cell);
    const auto [row, is_new] = rows.try_emplace(label, summary.rows.size());
    if (is_new) summary.rows.push_back({label, 0, 0, 0, 0});
    return summary.rows[row->second];
  };
  for (const std::size_t cell : chosen) {
    CampaignRow& row = row_of(cell);
    ++row.planned;
    ++row.kept;
  }
  for (const std::size_t cell : missing) --row_of(cell).kept;
  return summary;
}

void add_outcome(const CampaignPlan& plan, const Recorder& recorder, CampaignSummary& summary) {
  summary.run = recorder.done().size();
  summary.failed = recorder.failed().size();
  std::map<std::string, CampaignRow*> rows;
  for (CampaignRow& row : summary.rows) rows[row.label] = &row;
  for (const std::size_t cell : recorder.done()) ++rows[plan.label(cell)]->run;
  for (const std::size_t cell : recorder.failed()) ++rows[plan.label(cell)]->failed;
}

// J and errors of the nominal parameters of every calibration, to compare with.
std::vector<RunRecord> nominal_records(const CampaignPlan& plan, int threads, Watcher& watcher) {
  std::vector<RunRecord> records;
  const AcceptedKinds accepted = accepted_kinds(plan.campaign().accept);
  for (const LoadedProblem& one : plan.problems()) {
    const std::vector<std::string> findings = say_findings(one, accepted, true, threads, watcher);
    if (!one.calibration) continue;
    records.push_back(evaluation_record(one, "nominal", one.problem.start(), plan.context()));
    records.back().notes = findings;
  }
  return records;
}

std::vector<std::size_t> missing_cells(const CampaignStudy& study, const CampaignPlan& plan,
                                       const std::vector<std::size_t>& chosen,
                                       const std::unordered_set<std::string>& there) {
  if (!study.only.empty() && !study.plan_only) return chosen;
  std::vector<std::size_t> missing;
  for (const std::size_t cell : chosen)
    if (!there.contains(plan.keys()[cell])) missing.push_back(cell);
  return missing;
}

CampaignSummary plan_only(const CampaignStudy& study, const CampaignPlan& plan) {
  const std::vector<std::size_t> chosen = chosen_cells(study, plan);
  std::unordered_set<std::string> there;
  if (!study.store.empty() && std::filesystem::exists(study.store)) there = RecordStore(study.store).keys();
  CampaignSummary summary = summary_of(plan, chosen, missing_cells(study, plan, chosen, there));
  for (const std::size_t cell : chosen)
    summary.cells.push_back({plan.name(cell), plan.keys()[cell], there.contains(plan.keys()[cell])});
  return summary;
}

// The store takes up the campaign: what it is, and its cells in their order, behind the nominal records.
void begin(const CampaignStudy& study, const CampaignPlan& plan, const std::vector<RunRecord>& nominal,
           const std::unordered_set<std::string>& there, RecordStore& store) {
  std::vector<std::string> keys;
  for (const RunRecord& record : nominal) keys.push_back(record_key(record));
  keys.insert(keys.end(), plan.keys().begin(), plan.keys().end());
  store.begin_campaign({plan.campaign().name, plan.check_sum(), study.shard.text(),
                        plan.campaign().definition, static_cast<std::int64_t>(plan.size()), utc_now()},
                       keys);
  for (std::size_t k = 0; k < nominal.size(); ++k)
    if (!there.contains(keys[k]))
      store.append(keys[k], plan.campaign().name, static_cast<std::int64_t>(k), nominal[k]);
}

}  // namespace

CampaignSummary run_campaign(const CampaignStudy& study, const Catalogue& catalogue, Watcher& watcher,
                             const Stop& stop) {
  std::vector<std::string> notes;
  const InstructionSet kernel = kernel_in_force(study.kernel);
  const int threads = thread_count(study.threads);
  const CampaignPlan plan(read_campaign(study.file, catalogue, kernel, notes), catalogue,
                          run_context(threads, kernel), notes);
  for (const std::string& text : notes) watcher.note(text);
  if (study.plan_only) return plan_only(study, plan);

  const std::vector<std::size_t> chosen = chosen_cells(study, plan);
  const std::vector<RunRecord> nominal = nominal_records(plan, threads, watcher);
  watcher.results_begin();
  const std::unique_ptr<RecordStore> opened = open_to_write(study.store, study.patience, stop);
  RecordStore& store = *opened;
  const std::unordered_set<std::string> there = store.keys();
  const std::vector<std::size_t> missing = missing_cells(study, plan, chosen, there);
  CampaignSummary summary = summary_of(plan, chosen, missing);
  if (summary.kept > 0)
    watcher.note(fmt::format("{} of {} cells are in {} already and are kept; {} to run", summary.kept,
                             summary.planned, shown(study.store), missing.size()));
  begin(study, plan, nominal, there, store);
  // Children are made of a process of one thread.
  Recorder recorder(plan, missing, static_cast<std::int64_t>(nominal.size()), store, watcher,
                    !study.isolate.has_value());
  const auto start = std::chrono::steady_clock::now();
  watcher.runs_begin(missing.size(), [&](std::size_t i) {
    return plan.problem(missing[i]).name() + " " + plan.label(missing[i]);
  });
  if (study.isolate) {
    IsolatedCells cells(plan, missing, catalogue, stop, recorder);
    run_isolated(missing.size(), threads, *study.isolate, stop, cells);
  } else {
    run_side_by_side(missing.size(), threads, stop, [&](std::size_t i) {
      recorder.started(i);
      const auto record = run_one(plan, missing[i], threads, stop, catalogue,
                                  [&](const Progress& progress) { recorder.progressed(i, progress); });
      if (record) recorder.keep(i, *record);
    });
  }
  recorder.finish();
  watcher.runs_end();
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  summary.interrupted = stop.requested();
  add_outcome(plan, recorder, summary);
  return summary;
}

}  // namespace odobench
