#include "bench/studies/trust/fold_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "base/random.hpp"

namespace odobench {

std::vector<DrivesOfKind> kinds_of(std::span<const DriveName> drives) {
  std::vector<DrivesOfKind> kinds;
  std::map<std::string, std::size_t> places;
  for (std::size_t n = 0; n < drives.size(); ++n) {
    const auto [at, is_new] = places.emplace(drives[n].trajectory, kinds.size());
    if (is_new) kinds.push_back({drives[n].trajectory, {}});
    kinds[at->second].recordings.push_back(n);
  }
  return kinds;
}

FoldPlan leave_one_repetition_out(std::span<const DriveName> drives) {
  FoldPlan plan{"repetitions", {}, "", 0};
  std::map<int, std::vector<std::size_t>> folds;
  for (const DrivesOfKind& kind : kinds_of(drives)) {
    if (kind.recordings.size() < 2) {
      plan.never_left_out += kind.recordings.size();
      continue;
    }
    for (const std::size_t n : kind.recordings) folds[drives[n].repetition].push_back(n);
  }
  for (auto& [repetition, left_out] : folds) {
    std::sort(left_out.begin(), left_out.end());
    plan.folds.push_back({fmt::format("{}", repetition), std::move(left_out)});
  }
  if (plan.folds.empty())
    plan.why_not = drives.size() < 2 ? "there is one recording only"
                                     : "no kind of drive was driven twice: drive each at least three times";
  return plan;
}

FoldPlan leave_one_trajectory_out(std::span<const DriveName> drives) {
  FoldPlan plan{"trajectories", {}, "", 0};
  std::vector<DrivesOfKind> kinds = kinds_of(drives);
  if (kinds.size() < 2) {
    plan.why_not =
        drives.size() < 2 ? "there is one recording only" : "all recordings are of one kind of drive";
    return plan;
  }
  for (DrivesOfKind& kind : kinds) plan.folds.push_back({kind.trajectory, std::move(kind.recordings)});
  return plan;
}

FoldPlan stratified_k_fold(std::span<const DriveName> drives, int k, std::uint64_t seed) {
  if (k < 2 || static_cast<std::size_t>(k) > drives.size())
    throw std::invalid_argument(fmt::format(
        "kfold:{}: expected from 2 folds to as many as there are recordings ({})", k, drives.size()));
  FoldPlan plan{"kfold", {}, "", 0};
  for (int f = 1; f <= k; ++f) plan.folds.push_back({fmt::format("{}", f), {}});
  std::size_t next = 0;
  for (DrivesOfKind& kind : kinds_of(drives)) {
    Random random(derive_seed(seed, {"kfold", kind.trajectory}));
    for (std::size_t left = kind.recordings.size(); left > 1; --left)  // Fisher and Yates
      std::swap(
          kind.recordings[left - 1],
          kind.recordings[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(left) - 1))]);
    for (const std::size_t n : kind.recordings) plan.folds[next++ % plan.folds.size()].left_out.push_back(n);
  }
  for (Fold& fold : plan.folds) std::sort(fold.left_out.begin(), fold.left_out.end());
  return plan;
}

}  // namespace odobench
