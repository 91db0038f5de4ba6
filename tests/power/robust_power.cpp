// What corrupted recordings do to a calibration: two of the 30 published recordings are damaged, and totals
// on all 30 as they were are compared with those of a calibration of undamaged data. Prints the tables of
// docs/robust.md.
//
// usage: robust_power [SETS]      sets of each kind of damage, 20
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "base/range.hpp"
#include "problems/inspection/inspect.hpp"
#include "problems/trust/error_scales.hpp"
#include "problems/trust/sibling_screening.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/corrupted_drives.hpp"
#include "tests/support/data/vitko_problem.hpp"

namespace odobench {
namespace {

using testing::vitko_dataset;

Vector solved(const CalibrationProblem& problem, const Vector& start) {
  const Problem handle(std::shared_ptr<const CalibrationProblem>(&problem, [](const auto*) {}));
  return solve(handle, {"lm", {}}, start.size() > 0 ? start : handle.start(), {}).x;
}

CalibrationOptions thesis() {
  CalibrationOptions options;
  options.from_origin = true;
  return options;
}

// Sum over trajectories and x, y, theta of the mean largest error, m and rad, over the recordings with keep.
double total(const CalibrationProblem& problem, const Vector& z, bool untouched_only) {
  std::map<std::string, std::pair<double, int>> sums;
  for (const MaxErrors& e : problem.max_errors(z)) {
    if (untouched_only && testing::touched_by_corruptions(e.recording)) continue;
    sums[e.trajectory].first += e.x + e.y + e.theta;
    ++sums[e.trajectory].second;
  }
  double all = 0;
  for (const auto& [trajectory, sum] : sums) all += sum.first / sum.second;
  return all;
}

struct Methods {
  static constexpr std::array<const char*, 4> kNames{"screening, squared", "squared", "cauchy",
                                                     "cauchy:recording"};
  std::array<Vector, 4> z;
  Screening screening;
};

// Without `samples` no fit by the loss per sample, which takes longer than all others.
Methods fitted(const std::vector<Recording>& recordings, bool samples = true) {
  const Robot& robot = vitko_dataset().robot;
  Methods m;
  m.screening = screen_siblings(robot, recordings, thesis(), kUsualScreen);
  const CalibrationProblem squared(robot, recordings, thesis());
  m.z[0] = m.z[1] = solved(squared, {});
  if (const auto out = m.screening.set_aside(); !out.empty()) {
    std::vector<Recording> kept;
    for (std::size_t n = 0; n < recordings.size(); ++n)
      if (std::find(out.begin(), out.end(), n) == out.end()) kept.push_back(recordings[n]);
    m.z[0] = solved(CalibrationProblem(robot, kept, thesis()), {});
  }
  for (const int i : {2, 3}) {
    if (i == 2 && !samples) continue;
    CalibrationOptions options = thesis();
    options.loss = parse_loss(i == 2 ? "cauchy" : "cauchy:recording");
    const ErrorScales scales = error_scales(squared, m.z[1]);
    options.loss.position_scale = i == 2 ? scales.position : recording_scale(squared, m.z[1]);
    options.loss.heading_scale = scales.heading;
    m.z[static_cast<std::size_t>(i)] = solved(CalibrationProblem(robot, recordings, options), m.z[1]);
  }
  return m;
}

void fixed_table(const CalibrationProblem& clean) {
  fmt::print("| corruption |");
  for (const char* name : Methods::kNames) fmt::print(" {} |", name);
  fmt::print(" left out |\n|---|---|---|---|---|---|\n");
  for (const char* kind : {"clean", "swap", "slip", "outliers", "frozen", "swap+slip", "all"}) {
    std::vector<Recording> recordings = vitko_dataset().recordings;
    testing::corrupt(recordings, kind);
    const Methods m = fitted(recordings);
    fmt::print("| {} |", kind);
    for (const Vector& z : m.z) fmt::print(" {:.4f} |", total(clean, z, true));
    std::vector<std::string> names;
    for (const std::size_t n : m.screening.set_aside())
      names.push_back(fmt::format("{} ({:.3g})", recordings[n].id, m.screening.scores[n].z));
    fmt::print(" {} |\n", fmt::join(names, ", "));
    std::fflush(stdout);
  }
}

double worst(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

// Whether `bench inspect` says something about the recording that it does not say of the undamaged one.
bool named(const std::vector<inspection::Finding>& found, const std::string& id) {
  return std::any_of(found.begin(), found.end(),
                     [&](const inspection::Finding& f) { return f.recording == id; });
}

struct DamageSeen {
  testing::Damage damage;
  std::string id;
  bool left_out = false, inspected = false;
  double z = 0, alone = 0;  // alone in the set: what squares make of the total, %; where nobody saw it
};

struct Outcome {
  std::array<double, 4> total{}, cost{};  // changes in %; not-a-number of methods that were not run
  std::vector<DamageSeen> damages;
  int wrong = 0, said = 0;  // undamaged recordings left out, and named by inspect
  double largest = 0;       // z of these
};

struct Judge {
  const CalibrationProblem& clean;
  double usual, cost;

  double change(const Vector& z) const { return 100 * (total(clean, z, false) / usual - 1); }
  Outcome of(const std::string& kind, int set, bool samples) const;
};

Outcome Judge::of(const std::string& kind, int set, bool samples) const {
  std::vector<Recording> recordings = vitko_dataset().recordings;
  const auto done = testing::damage_two(recordings, kind, 7000 + static_cast<std::uint64_t>(set));
  const Methods m = fitted(recordings, samples);
  Outcome out;
  for (std::size_t i = 0; i < m.z.size(); ++i) {
    out.total[i] = out.cost[i] = kNotANumber;
    if (m.z[i].size() == 0) continue;
    out.total[i] = change(m.z[i]);
    out.cost[i] = 100 * (clean.cost(m.z[i]) / cost - 1);
  }
  const auto found = inspection::inspect(vitko_dataset().robot, recordings, 1);
  for (const testing::Damage& d : done) {
    const SiblingScore& score = m.screening.scores[d.recording];
    DamageSeen seen{d, recordings[d.recording].id, score.set_aside, named(found, recordings[d.recording].id),
                    score.z};
    if (!seen.left_out && !seen.inspected) {
      std::vector<Recording> one = vitko_dataset().recordings;
      one[d.recording] = recordings[d.recording];
      seen.alone = change(solved(CalibrationProblem(vitko_dataset().robot, one, thesis()), {}));
    }
    out.damages.push_back(seen);
  }
  for (std::size_t n = 0; n < recordings.size(); ++n) {
    if (n == done[0].recording || n == done[1].recording) continue;
    out.largest = std::max(out.largest, m.screening.scores[n].z);
    out.wrong += m.screening.scores[n].set_aside;
    out.said += named(found, recordings[n].id);
  }
  return out;
}

void loss_rows(const std::string& kind, const std::vector<const Outcome*>& outcomes) {
  for (std::size_t i = 0; i < Methods::kNames.size(); ++i) {
    std::vector<double> costs, totals;
    for (const Outcome* o : outcomes)
      if (std::isfinite(o->total[i])) {
        costs.push_back(o->cost[i]);
        totals.push_back(o->total[i]);
      }
    if (totals.empty()) continue;
    const auto beyond = std::count_if(totals.begin(), totals.end(), [](double t) { return t > 3; });
    fmt::print("| {} | {} | {:+.2f} | {:+.2f} | {:+.2f} | {:+.2f} | {} of {} |\n", kind, Methods::kNames[i],
               middle_of(costs), worst(costs), middle_of(totals), worst(totals), beyond, totals.size());
  }
}

void damage_table(const std::vector<Outcome>& outcomes) {
  fmt::print(
      "\n| damage | recordings | left out | named by inspect | either | neither, and alone within 1 % |\n"
      "|---|---|---|---|---|---|\n");
  int wrong = 0, said = 0;
  double largest = 0;
  std::map<std::string, std::array<int, 5>> bad;
  for (const Outcome& o : outcomes) {
    wrong += o.wrong;
    said += o.said;
    largest = std::max(largest, o.largest);
    for (const DamageSeen& d : o.damages) {
      auto& c = bad[d.damage.kind];
      ++c[0];
      c[1] += d.left_out;
      c[2] += d.inspected;
      c[3] += d.left_out || d.inspected;
      c[4] += !d.left_out && !d.inspected && d.alone <= 1;
    }
  }
  for (const auto& [kind, c] : bad)
    fmt::print("| {} | {} | {} | {} | {} | {} of {} |\n", kind, c[0], c[1], c[2], c[3], c[4], c[0] - c[3]);
  fmt::print("\nundamaged recordings left out: {}, named by inspect: {}, largest z {:.3g}\n", wrong, said,
             largest);
  for (const Outcome& o : outcomes)
    for (const DamageSeen& d : o.damages)
      if (!d.left_out && !d.inspected)
        fmt::print("  neither: {}, {}: z {:.2g}, alone {:+.2f} %\n", d.id, d.damage.text, d.z, d.alone);
}

void random_tables(const CalibrationProblem& clean, int sets, std::size_t every) {
  const Vector best = solved(clean, {});
  const Judge judge{clean, total(clean, best, false), clean.cost(best)};
  const std::array<const char*, 5> kinds{"slip", "swap", "outlier", "pose", "mix"};
  const auto each = static_cast<std::size_t>(sets);
  std::vector<Outcome> outcomes(kinds.size() * each);
  parallel_for(outcomes.size(), 0, [&](std::size_t i) {
    outcomes[i] = judge.of(kinds[i / each], static_cast<int>(i % each), i % every == 0);
    fmt::print(stderr, "{} ", i);
  });
  fmt::print(
      "\n| damage | loss | J median | J worst | total median | total worst | beyond +3 % |\n"
      "|---|---|---|---|---|---|---|\n");
  std::vector<const Outcome*> all;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    std::vector<const Outcome*> own;
    for (std::size_t s = 0; s < each; ++s) own.push_back(&outcomes[k * each + s]);
    loss_rows(kinds[k], own);
    all.insert(all.end(), own.begin(), own.end());
  }
  loss_rows("all", all);
  damage_table(outcomes);
}

}  // namespace

// The loss per sample on one set of `every`: it takes longer than all others.
int robust_power(int sets, std::size_t every) {
  if (!testing::has_shared()) {
    fmt::print(stderr, "robust_power: needs {} (set ODOBENCH_SHARED)\n", testing::shared_folder().string());
    return 2;
  }
  const CalibrationProblem clean(vitko_dataset().robot, vitko_dataset().recordings, thesis());
  if (sets > 0) random_tables(clean, sets, every);
  fixed_table(clean);
  return 0;
}

}  // namespace odobench

int main(int argc, char** argv) {
  return odobench::robust_power(argc > 1 ? std::atoi(argv[1]) : 20,
                                static_cast<std::size_t>(argc > 2 ? std::max(1, std::atoi(argv[2])) : 5));
}
