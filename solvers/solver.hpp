// What a method is: a solver lowers the cost of a Run. Adding one = a pair of files with a SolverEntry
// factory and a row in registry.cpp; lists, tables, documentation and the conformance tests pick it up by
// themselves.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "solvers/options.hpp"
#include "solvers/run.hpp"

namespace odobench {

// How the method itself ended: Settled by a tolerance of its own, Stalled without further progress,
// IterationLimit, Failed. It never says Converged: solve() does, by its own test. When run.stop() holds the
// driver's reason replaces it. One of several optima that a method has seen.
struct LocalOptimum {
  Vector x;  // parameter units
  double cost = 0;
  int runs = 0;  // local searches that ended there: their share is the basin's
};

struct Outcome {
  Termination termination = Termination::NotStarted;
  std::string message;  // one sentence with both numbers: "projected gradient 3e-11 <= 1e-10"
  // The answer is the best of admissible levels, about which derivatives say nothing.
  bool on_lattice = false;
  // Distinct optima of a method that starts many times, the lowest first; else empty.
  std::vector<LocalOptimum> optima = {};
};

class Solver {
 public:
  virtual ~Solver() = default;
  // "" when the method can run on the problem, else the reason shown as a table row.
  virtual std::string why_not(const Problem& problem) const = 0;
  // Runs until converged or run.stop(). The answer is the best point the run has seen.
  virtual Outcome minimise(Run& run) const = 0;
};

struct SolverEntry {
  std::string name;     // "lm", "nlopt:bobyqa"
  std::string summary;  // one line for `bench list solvers`
  bool stochastic = false;
  // The options with defaults, ranges and help.
  std::function<std::vector<OptionDescription>()> options;
  // Throws std::invalid_argument on unknown options or values out of range. `in_force`, if not null, receives
  // every option with its value.
  std::function<std::unique_ptr<Solver>(const OptionValues& values, OptionValues* in_force)> make;
};

// Builds the two callables of an entry for a solver class constructed from its Options struct, which has
//   void bind(OptionBinder&)   and   void validate() const  (relations between fields; throws
//   std::invalid_argument).
template <class SolverClass, class Options>
SolverEntry make_entry(std::string name, std::string summary, bool stochastic, Options defaults = {}) {
  SolverEntry entry{name, std::move(summary), stochastic, {}, {}};
  entry.options = [defaults] {
    Options options = defaults;
    OptionBinder binder;
    options.bind(binder);
    return binder.describe();
  };
  entry.make = [name, defaults](const OptionValues& values,
                                OptionValues* in_force) -> std::unique_ptr<Solver> {
    Options options = defaults;
    OptionBinder binder;
    options.bind(binder);
    binder.apply(name, values);
    options.validate();
    if (in_force != nullptr) *in_force = binder.values();
    return std::make_unique<SolverClass>(options);
  };
  return entry;
}

}  // namespace odobench
