// Validation, bootstrap, profiles, combinations and noise of the results of a run, before its records are
// written for good.
#pragma once

#include <vector>

#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/calibration/solver_study.hpp"
#include "bench/studies/run_folder.hpp"
#include "bench/studies/trust/trust_choice.hpp"
#include "bench/studies/watcher.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// A record counts as the optimum that was validated when its J is at most this above it, relative.
inline constexpr double kSameOptimum = 1e-6;

// Of each calibration among the problems: one fit by `lm` from the lowest run, its folds, with --bootstrap
// its replicates and with --profile J along its parameters. The figures go to the records that tables show,
// and to the lowest of each row, whose J is that of the fit within kSameOptimum; replicates and profiles to
// the lowest run, combinations to all of them. With ValidationChoice::own_solvers the lowest run of every row
// is validated by fits of its own solver from the nominal parameters instead.
//
// What keeps a validation from being made is said to the watcher: as a note, as a warning where it was asked
// for. A result that is worse than the nominal parameters on recordings left out is a warning.
class TrustStudy {
 public:
  // All outlive the object.
  TrustStudy(const TrustChoice& choice, const SolverStudy& study, const Catalogue& catalogue,
             const RunFolder& folder, Watcher& watcher, const Stop& stop);

  // Throws std::invalid_argument where a bootstrap is asked for that these problems do not have: before the
  // runs.
  void require(const std::vector<LoadedProblem>& loaded) const;
  // Adds to the records; returns whether it did. An interruption ends it: what is in the records stays.
  bool judge(const std::vector<LoadedProblem>& loaded, std::vector<RunRecord>& records);
  bool interrupted() const { return interrupted_; }
  // The study with require() and judge() of this object as its members of these names, and the noise of the
  // odometry as what describes its lowest runs.
  SolverStudy with(SolverStudy study);

 private:
  struct Subject;  // one calibration with its runs
  bool judge(Subject& subject);
  std::vector<FoldPlan> plans(const Subject& subject) const;
  bool affordable(const Subject& subject, const std::vector<FoldPlan>& plans) const;
  bool validate_shared(Subject& subject, const std::vector<FoldPlan>& plans);
  bool validate_own(Subject& subject, const std::vector<FoldPlan>& plans);
  bool resample(Subject& subject);
  void require_names(const LoadedProblem& one) const;
  const Refit& full_fit(Subject& subject);
  bool profile(Subject& subject);
  bool combine(Subject& subject);
  void warn_of(const RunRecord& record) const;

  const TrustChoice& choice_;
  const SolverStudy& study_;
  const Catalogue& catalogue_;
  const RunFolder& folder_;
  Watcher& watcher_;
  const Stop& stop_;
  bool interrupted_ = false;
};

}  // namespace odobench
