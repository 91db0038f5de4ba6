#include "bench/studies/cells.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <iterator>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "bench/studies/context.hpp"

namespace odobench {
namespace {

// Hands out the work in order and keeps the first exception.
class Dispatcher {
 public:
  Dispatcher(std::size_t count, const Stop& stop, const std::function<void(std::size_t)>& call)
      : count_(count), asked_(stop), call_(call) {}

  void work() {
    while (!stop_.load() && !asked_.requested()) {
      const std::size_t next = next_.fetch_add(1);
      if (next >= count_) return;
      try {
        call_(next);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!error_) error_ = std::current_exception();
        stop_.store(true);
      }
    }
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  const std::size_t count_;
  const Stop asked_;
  const std::function<void(std::size_t)>& call_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace

std::string RunCell::label() const {
  return polish.name.empty() ? solver.text() : solver.text() + "+" + polish.text();
}

std::vector<SolverSpec> resolve_solvers(const Catalogue& catalogue, const std::vector<std::string>& lists,
                                        std::vector<std::string>& notes) {
  std::vector<SolverSpec> specs;
  std::set<std::string> seen;
  const auto take = [&](const SolverSpec& spec) {
    catalogue.solver(spec.name).make(spec.options, nullptr);  // throws on an unknown name or a bad option
    if (seen.insert(spec.text()).second)
      specs.push_back(spec);
    else
      notes.push_back(fmt::format("solver '{}' is listed more than once and runs once", spec.text()));
  };
  for (const std::string& list : lists)
    for (const SolverSpec& spec : parse_solver_list(list)) {
      if (spec.name == "all" && spec.options.empty())
        for (const SolverEntry& entry : catalogue.solvers().entries()) take({entry.name, {}});
      else
        take(spec);
    }
  return specs;
}

void CellList::add(const CellPlan& plan, std::size_t problem, std::vector<std::string>& notes) {
  std::string once;
  for (std::size_t k = 0; k < plan.solvers.size(); ++k) {
    const SolverSpec& solver = plan.solvers[k];
    const bool same_each_time = !catalogue_->solver(solver.name).stochastic && !plan.random_start;
    if (same_each_time && plan.repeat > 1) once += (once.empty() ? "" : ", ") + solver.text();
    groups_.push_back({size_, k, plans_.size()});
    size_ += same_each_time ? 1 : static_cast<std::size_t>(plan.repeat);
  }
  plans_.push_back(plan);
  problems_.push_back(problem);
  if (size_ > kMostRuns)
    throw std::invalid_argument(fmt::format(
        "--repeat={}: together more than {} runs; expected fewer repetitions, solvers or problems, "
        "or several calls, each with its --seed",
        plan.repeat, kMostRuns));
  if (!once.empty())
    notes.push_back(fmt::format("{}: deterministic, so run once from the {} start instead of {} times", once,
                                plan.start_name.empty() ? "nominal" : plan.start_name, plan.repeat));
}

RunCell CellList::operator[](std::size_t index) const {
  const auto after = std::upper_bound(groups_.begin(), groups_.end(), index,
                                      [](std::size_t i, const Group& group) { return i < group.begin; });
  const Group& group = *std::prev(after);
  const CellPlan& plan = plans_[group.plan];
  RunCell cell;
  cell.solver = plan.solvers[group.solver];
  if (cell.solver.name != plan.polish.name) cell.polish = plan.polish;
  cell.problem = problems_[group.plan];
  cell.repetition = static_cast<int>(index - group.begin) + 1;
  const std::string number = std::to_string(cell.repetition);
  cell.seed = derive_seed(plan.base_seed, {plan.problem, plan.dataset, cell.solver.text(), number});
  cell.start_seed = derive_seed(plan.base_seed, {plan.problem, plan.dataset, "start", number});
  cell.random_start = plan.random_start;
  cell.start_name = plan.start_name;
  cell.start = plan.start;
  cell.draws_random_numbers = catalogue_->solver(cell.solver.name).stochastic ||
                              (!cell.polish.name.empty() && catalogue_->solver(cell.polish.name).stochastic);
  return cell;
}

std::optional<Result> run_cell(Problem own, const RunCell& cell, const Budget& budget, int threads,
                               const Stop& stop, const Catalogue& catalogue, Observer observer) {
  SolveOptions options;
  options.budget = budget;
  options.seed = cell.seed;
  options.interrupt = stop.flag();
  options.threads = threads;
  options.polish = cell.polish;
  options.solvers = &catalogue.solvers();
  options.observer = std::move(observer);
  const Vector start = cell.random_start        ? random_start(own, cell.start_seed)
                       : cell.start.size() == 0 ? own.start()
                                                : cell.start;
  Result result = solve(own, cell.solver, start, options);
  if (result.termination == Termination::Interrupted && !result.usable()) return std::nullopt;
  return result;
}

void run_side_by_side(std::size_t count, int threads, const Stop& stop,
                      const std::function<void(std::size_t)>& work) {
  Dispatcher dispatcher(count, stop, work);
  if (threads <= 1) {
    dispatcher.work();
  } else {
    // The library's own limit is one thread per core; asking for more must give more.
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                              static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    Meeting meeting;
    meeting.arrive();
    arena.execute([&] {
      const auto one = [&] {
        meeting.arrive();
        dispatcher.work();
        meeting.arrive();
      };
      tbb::task_group workers;
      for (int i = 1; i < threads; ++i) workers.run(one);
      one();
      workers.wait();
    });
    meeting.arrive();
  }
  dispatcher.rethrow();
}

void run_cells(const std::vector<Problem>& problems, const CellList& cells,
               const std::vector<std::size_t>& which, const Budget& budget, int threads, const Stop& stop,
               CellWatcher& watcher) {
  run_side_by_side(which.size(), threads, stop, [&](std::size_t i) {
    const std::size_t index = which[i];
    const RunCell cell = cells[index];
    watcher.started(index);
    const std::string begin = utc_now();
    const std::optional<Result> result =
        run_cell(problems[cell.problem], cell, budget, threads, stop, cells.catalogue(),
                 [&watcher, index](const Progress& progress) { watcher.progressed(index, progress); });
    if (result) watcher.finished(index, *result, begin);
  });
}

void run_cells(const std::vector<Problem>& problems, const CellList& cells, const Budget& budget, int threads,
               const Stop& stop, CellWatcher& watcher) {
  std::vector<std::size_t> all(cells.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  run_cells(problems, cells, all, budget, threads, stop, watcher);
}

}  // namespace odobench
