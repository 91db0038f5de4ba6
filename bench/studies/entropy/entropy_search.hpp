// The method of `bench filter`: one of the searches made for the filter's blocks, or any solver of the
// registry.
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "base/stop.hpp"
#include "bench/catalogue/catalogue.hpp"
#include "problems/block_quadratic.hpp"
#include "problems/entropy/profile_form.hpp"
#include "problems/instruction_set.hpp"
#include "solvers/solve.hpp"

namespace odobench {

// Solves every window as a problem of the shared cost interface: slower by what that costs, and open to every
// solver.
class RegistrySearch final : public BlockSearch {
 public:
  // Seeds are derived from `seed`, the solver and the number of the window.
  RegistrySearch(const ProfileForm& profile, const Catalogue& catalogue, SolverSpec solver,
                 const Budget& budget, std::uint64_t seed, const Stop& stop);

  // Every sample that the filter gets, before it gets it.
  void observe(const EntropySample& sample);
  // Throws std::invalid_argument when the solver cannot run on such windows, std::runtime_error when it has
  // no result.
  SearchResult minimise(std::span<const double> g, std::span<double> x) override;

 private:
  const ProfileForm& profile_;
  SolverSpec solver_;
  const Stop stop_;
  SolveOptions options_;
  std::uint64_t seed_;
  std::int64_t window_ = 0;
  std::deque<EntropySample> samples_;
};

struct FilterMethod {
  SolverSpec spec;                      // "zero" is no solver of the registry
  std::unique_ptr<BlockSearch> search;  // null for zero increments
  RegistrySearch* registry = nullptr;   // the same object when it is one
};

// `text` as typed: coordinate, exact, relaxed, zero, or a solver of the registry. `profile` outlives the
// result. Throws std::invalid_argument on what is none of them or several.
FilterMethod make_filter_method(const std::string& text, const Catalogue& catalogue,
                                const ProfileForm& profile, const Budget& budget, std::uint64_t seed,
                                InstructionSet kernel, const Stop& stop);

}  // namespace odobench
