// The cells of a comparison (solver x repetition), their seeds and starts, and running them side by side.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/catalogue/catalogue.hpp"
#include "problems/problem.hpp"
#include "solvers/solve.hpp"

namespace odobench {

struct RunCell {
  SolverSpec solver;
  SolverSpec polish;        // name "" means none
  std::size_t problem = 0;  // place in the list of problems that run_cells gets
  int repetition = 1;
  std::uint64_t seed = 0;
  std::uint64_t start_seed = 0;  // of a random start
  bool random_start = false;
  std::string start_name;  // of another start than the nominal one: "censi"
  Vector start;            // that one, in parameter units; empty: the problem's own

  bool draws_random_numbers = false;  // its solver or its polish; a random start apart

  std::string label() const;  // of its table row: "pso", "pso[swarm=60]+lm"
};

struct CellPlan {
  std::vector<SolverSpec> solvers;
  SolverSpec polish;
  int repeat = 1;
  std::uint64_t base_seed = 1;
  bool random_start = false;
  std::string start_name;  // as of RunCell
  Vector start;
  std::string problem, dataset;  // names the seeds are derived from
};

// Reads comma lists of solvers, expands "all" to the whole catalogue and checks every option. Throws
// std::invalid_argument; a solver listed twice is dropped with a line in `notes`.
std::vector<SolverSpec> resolve_solvers(const Catalogue& catalogue, const std::vector<std::string>& lists,
                                        std::vector<std::string>& notes);

// Runs of one call at most: their records are kept until the tables are made, up to 20 kB each.
inline constexpr std::size_t kMostRuns = 200'000;

// The cells of any number of problems. A cell is made when it is asked for, so that a hundred thousand
// repetitions begin at once.
class CellList {
 public:
  // The catalogue outlives the list.
  explicit CellList(const Catalogue& catalogue) : catalogue_(&catalogue) {}

  // One cell per solver and repetition, solver by solver. Seeds: derive_seed(base, {problem, data set,
  // solver, repetition}); random starts: derive_seed(base, {problem, data set, "start", repetition}), the
  // same for every solver. A deterministic solver from a start that is always the same gives the same
  // answer each time: it gets one cell, and `notes` a line. A polish applies to every solver but itself.
  // `problem`: as of RunCell. Throws std::invalid_argument when there are more than kMostRuns.
  void add(const CellPlan& plan, std::size_t problem, std::vector<std::string>& notes);

  std::size_t size() const { return size_; }
  const Catalogue& catalogue() const { return *catalogue_; }
  RunCell operator[](std::size_t cell) const;

 private:
  struct Group {
    std::size_t begin = 0, solver = 0, plan = 0;
  };
  const Catalogue* catalogue_;
  std::size_t size_ = 0;
  std::vector<CellPlan> plans_;
  std::vector<std::size_t> problems_;  // of each plan
  std::vector<Group> groups_;
};

// What is going on, called from the threads that run: implementations lock.
class CellWatcher {
 public:
  virtual ~CellWatcher() = default;
  virtual void started(std::size_t cell) = 0;
  virtual void progressed(std::size_t cell, const Progress& progress) = 0;
  // `time_utc`: when the run began.
  virtual void finished(std::size_t cell, const Result& result, const std::string& time_utc) = 0;
};

// Solves one cell; `own` is a copy for it alone. Nothing when it was stopped before anything was evaluated.
std::optional<Result> run_cell(Problem own, const RunCell& cell, const Budget& budget, int threads,
                               const Stop& stop, const Catalogue& catalogue, Observer observer);

// work(0) ... work(count - 1), begun in this order, on `threads` threads; batches of a population solver in
// them use threads that have no work left. After `stop` nothing further begins; after an exception neither,
// and it is thrown from here.
void run_side_by_side(std::size_t count, int threads, const Stop& stop,
                      const std::function<void(std::size_t)>& work);

// Runs the cells `which` by run_side_by_side(). Results do not depend on `threads`. A cell that had not
// evaluated anything when the stop came is not reported. An exception of the watcher (a record that cannot be
// written) ends it.
void run_cells(const std::vector<Problem>& problems, const CellList& cells,
               const std::vector<std::size_t>& which, const Budget& budget, int threads, const Stop& stop,
               CellWatcher& watcher);
// All of them.
void run_cells(const std::vector<Problem>& problems, const CellList& cells, const Budget& budget, int threads,
               const Stop& stop, CellWatcher& watcher);

}  // namespace odobench
