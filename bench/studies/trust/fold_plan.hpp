// Which recordings are left out together: the folds of a validation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace odobench {

// What a plan has to know of a recording.
struct DriveName {
  std::string trajectory;  // the kind of drive
  int repetition = 1;
};

struct Fold {
  std::string name;                   // "2" (a repetition, a fold's number) or "line_y" (a kind)
  std::vector<std::size_t> left_out;  // recordings, ascending; the fold's fit does not see them
};

struct FoldPlan {
  std::string scheme;  // "repetitions", "trajectories", "kfold"
  std::vector<Fold> folds;
  std::string why_not;  // a sentence where there are no folds, else ""
  // Recordings that no fold leaves out, and that are therefore in every fit and never judged.
  std::size_t never_left_out = 0;
};

// "The same drives again": fold k leaves out every recording with repetition k whose kind has another
// recording. A kind that was driven once is left in all fits: without it that question would be the next
// one.
FoldPlan leave_one_repetition_out(std::span<const DriveName> drives);

// "A kind of drive never seen": a fold per trajectory, in order of first appearance.
FoldPlan leave_one_trajectory_out(std::span<const DriveName> drives);

// k folds of nearly equal size, stratified: the recordings of each kind, in an order drawn from
// derive_seed(seed, {"kfold", kind}), are dealt to the folds one by one, the next kind where the last one
// ended. Throws std::invalid_argument for k < 2 or more folds than recordings.
FoldPlan stratified_k_fold(std::span<const DriveName> drives, int k, std::uint64_t seed);

// Kinds in order of first appearance, each with its recordings.
struct DrivesOfKind {
  std::string trajectory;
  std::vector<std::size_t> recordings;
};
std::vector<DrivesOfKind> kinds_of(std::span<const DriveName> drives);

}  // namespace odobench
