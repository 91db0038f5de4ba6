#include "bench/studies/calibration/derivative_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/random.hpp"
#include "solvers/certificate/derivative_check.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

constexpr int kRandomPoints = 3;

struct Worst {
  DerivativeComparison comparison;
  std::string point;
};

// How far from agreement: above 1 it does not.
double ratio(const DerivativeComparison& c) {
  return std::isnan(c.error) ? std::numeric_limits<double>::infinity() : c.error / c.limit;
}

std::vector<Cell> row(const std::string& problem, const Worst& worst) {
  const DerivativeComparison& c = worst.comparison;
  return {text_cell(c.parameter),
          text_cell(problem),
          text_cell(c.kind),
          significant_cell(c.error, 2),
          significant_cell(c.limit, 2),
          significant_cell(c.stated, 8),
          significant_cell(c.differenced, 8),
          text_cell(worst.point),
          text_cell(!c.agrees()     ? "DISAGREES"
                    : c.undecided() ? "not decided"
                                    : "agrees")};
}

// The worst point of every parameter and kind, in their order; `points` counts those where there was anything
// to compare.
std::vector<Worst> worst_of(const LoadedProblem& loaded, std::uint64_t base_seed, int& points,
                            Watcher& watcher) {
  std::vector<Worst> worst;
  for (int k = 0; k <= kRandomPoints; ++k) {
    const std::uint64_t seed =
        derive_seed(base_seed, {loaded.name(), loaded.dataset_name(), "derivatives", std::to_string(k)});
    const Vector x = k == 0 ? loaded.problem.start() : random_start(loaded.problem, seed);
    const auto found = compare_derivatives(loaded.problem, x);
    points += found.empty() ? 0 : 1;
    const std::string point = k == 0 ? "start" : fmt::format("random {}", k);
    if (worst.empty())
      for (const DerivativeComparison& c : found) worst.push_back({c, point});
    else
      for (std::size_t i = 0; i < found.size(); ++i)
        if (ratio(found[i]) > ratio(worst[i].comparison)) worst[i] = {found[i], point};
    watcher.count_one();
  }
  return worst;
}

}  // namespace

DerivativeTable check_derivatives(const std::vector<LoadedProblem>& problems, std::uint64_t base_seed,
                                  Watcher& watcher, const Stop& stop) {
  DerivativeTable result;
  Table& table = result.table;
  table.id = "derivatives";
  table.title = "Derivatives against differences";
  table.columns = {text_column("parameter"),
                   text_column("problem"),
                   text_column("kind", "derivative"),
                   number_column("error", "relative error", "", "error"),
                   number_column("limit", "limit", "", "error"),
                   number_column("stated", "stated", "", "value"),
                   number_column("differenced", "by differences", "", "value"),
                   text_column("point", "at"),
                   text_column("verdict")};
  watcher.count_begins("points", static_cast<std::int64_t>(problems.size()) * (kRandomPoints + 1));
  int wrong = 0;
  for (const LoadedProblem& loaded : problems) {
    stop.check();
    int here = 0;
    for (const Worst& worst : worst_of(loaded, base_seed, here, watcher)) {
      table.rows.push_back(row(loaded.name(), worst));
      wrong += !worst.comparison.agrees();
    }
    if (!loaded.problem.has_gradient())
      table.notes.push_back(fmt::format("{}: it has no derivatives.", loaded.name()));
    else if (here <= kRandomPoints)
      table.notes.push_back(fmt::format("{}: at {} of {} points the cost is not finite.", loaded.name(),
                                        kRandomPoints + 1 - here, kRandomPoints + 1));
  }
  watcher.count_ends();
  result.agrees = wrong == 0;
  table.notes.push_back(
      fmt::format("Ridders' extrapolated differences at the start and {} random points of the box, the worst "
                  "of them shown; relative to the "
                  "largest entry of the column. {} of {} derivatives disagree.",
                  kRandomPoints, wrong, table.rows.size()));
  return result;
}

}  // namespace odobench
