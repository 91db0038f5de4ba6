#include "bench/studies/planning/rival_models.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"

namespace odobench {
namespace {

constexpr double kSameTime_s = 0.2;

// Least time to the decision first; of those that take the same, and of those that do not decide, the larger
// separation.
bool before(const RivalDrive& a, const RivalDrive& b) {
  if (a.repetitions.has_value() != b.repetitions.has_value()) return a.repetitions.has_value();
  if (a.repetitions) {
    const double ta = *a.repetitions * a.seconds, tb = *b.repetitions * b.seconds;
    if (std::abs(ta - tb) > kSameTime_s) return ta < tb;
  }
  return a.discrimination.separation(1) > b.discrimination.separation(1);
}

EndPrediction prediction(const DrivePredictions& of, std::size_t drive) {
  const Matrix jacobian = of.end_jacobian(drive);
  return {of.end(drive), jacobian * of.covariance() * jacobian.transpose()};
}

}  // namespace

RivalPlan plan_rivals(const CalibrationProblem& plain, const Robot& robot, const ModelFits& a,
                      const ModelFits& b, int threads, const Stop& stop) {
  RivalPlan plan;
  const std::vector<DriveCandidate> candidates = drive_candidates(plain, robot);
  const DrivePredictions first(plain, robot, a, candidates), second(plain, robot, b, candidates);
  const DrivePredictions& better = b.cost < a.cost ? second : first;
  const DriveNoise noise(better.noise_drives());
  plan.refused = noise.refused();
  if (!plan.refused.empty()) return plan;
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (first.knows(candidates[i]) && second.knows(candidates[i]))
      known.push_back(i);
    else
      plan.unknown.push_back(candidates[i].name);
  }
  plan.drives.resize(known.size());
  parallel_for(
      known.size(), threads,
      [&](std::size_t k) {
        const std::size_t i = known[k];
        const PoseTrack track = better.track(i);
        EndPrediction of_a = prediction(first, i);
        of_a.open += noise.repeating(track);  // counts once, of whichever
        RivalDrive& d = plan.drives[k];
        d.name = candidates[i].name;
        d.description = candidates[i].description;
        d.recorded = candidates[i].recorded;
        d.seconds = 1e-6 * static_cast<double>(candidates[i].recording.time_us.back());
        d.discrimination = discriminate(of_a, prediction(second, i), noise.scatter(track));
        d.repetitions = d.discrimination.repetitions();
      },
      stop);
  std::stable_sort(plan.drives.begin(), plan.drives.end(), before);
  return plan;
}

}  // namespace odobench
