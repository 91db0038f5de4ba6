#include "bench/studies/planning/settling_plan.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"

namespace odobench {
namespace {

constexpr double kNormal95 = 1.96, kOpenShare = 0.5, kLeastGain = 0.01;

struct Informer {
  Matrix jacobian;  // in units of the boxes' half widths, of the free parameters
  Eigen::Matrix3d scatter, repeating;
  Matrix information(int n) const {
    if (n == 0) return Matrix::Zero(jacobian.cols(), jacobian.cols());
    const Eigen::Matrix3d one = scatter / n + repeating;
    return jacobian.transpose() * one.ldlt().solve(jacobian);
  }
};

class Settling {
 public:
  Settling(const DrivePredictions& predictions, const DriveNoise& noise, std::size_t candidates, int threads,
           const Stop& stop)
      : counts_(candidates, 0), informers_(candidates) {
    const std::vector<ParameterInfo>& parameters = predictions.parameters();
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (parameters[i].lower < parameters[i].upper) free_.push_back(static_cast<Eigen::Index>(i));
    const auto n = static_cast<Eigen::Index>(free_.size());
    half_.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const ParameterInfo& p = parameters[static_cast<std::size_t>(free_[static_cast<std::size_t>(i)])];
      half_[i] = (p.upper - p.lower) / 2;
    }
    Matrix covariance(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index k = 0; k < n; ++k)
        covariance(i, k) = predictions.covariance()(at(i), at(k)) / (half_[i] * half_[k]);
    prior_ = covariance.ldlt().solve(Matrix::Identity(n, n));
    parallel_for(
        candidates, threads,
        [&](std::size_t d) {
          const PoseTrack track = predictions.track(d);
          const Matrix all = predictions.end_jacobian(d);
          Informer& informer = informers_[d];
          informer.jacobian.resize(3, n);
          for (Eigen::Index i = 0; i < n; ++i) informer.jacobian.col(i) = all.col(at(i)) * half_[i];
          informer.scatter = noise.scatter(track);
          informer.repeating = noise.repeating(track);
        },
        stop);
  }
  Eigen::Index at(Eigen::Index i) const { return free_[static_cast<std::size_t>(i)]; }
  std::size_t size() const { return free_.size(); }
  // 95 % half widths over those of the boxes.
  Vector widths(const std::vector<int>& counts) const {
    Matrix information = prior_;
    for (std::size_t d = 0; d < informers_.size(); ++d)
      if (counts[d] > 0) information += informers_[d].information(counts[d]);
    const auto n = information.rows();
    return kNormal95 * information.ldlt().solve(Matrix::Identity(n, n)).diagonal().cwiseMax(0.0).cwiseSqrt();
  }
  std::vector<int>& counts() { return counts_; }

 private:
  std::vector<Eigen::Index> free_;
  Vector half_;
  Matrix prior_;
  std::vector<int> counts_;
  std::vector<Informer> informers_;
};

// Sum over those open of the logarithm of what is beyond the share that counts as settled.
double excess(const Vector& widths, const std::vector<Eigen::Index>& open) {
  double sum = 0;
  for (const Eigen::Index i : open) sum += std::max(0.0, std::log(widths[i] / kOpenShare));
  return sum;
}

double largest(const Vector& widths, const std::vector<Eigen::Index>& open) {
  double most = 0;
  for (const Eigen::Index i : open) most = std::max(most, widths[i]);
  return most;
}

// The drives in the order in which they are first used.
std::vector<std::size_t> choose(Settling& settling, const std::vector<Eigen::Index>& open, const Stop& stop) {
  std::vector<std::size_t> order;
  std::vector<int>& counts = settling.counts();
  double now = excess(settling.widths(counts), open);
  for (int used = 0; used < kMostSettling && now > 0; ++used) {
    stop.check();
    std::size_t best = counts.size();
    double lowest = now * (1 - kLeastGain);
    for (std::size_t d = 0; d < counts.size(); ++d) {
      ++counts[d];
      const double value = excess(settling.widths(counts), open);
      --counts[d];
      if (value < lowest) {
        lowest = value;
        best = d;
      }
    }
    if (best == counts.size()) break;
    if (counts[best]++ == 0) order.push_back(best);
    now = lowest;
  }
  return order;
}

}  // namespace

SettlingPlan plan_settling(const CalibrationProblem& plain, const Robot& robot, const ModelFits& fits,
                           int threads, const Stop& stop) {
  SettlingPlan plan;
  const std::vector<DriveCandidate> candidates = drive_candidates(plain, robot);
  const DrivePredictions predictions(plain, robot, fits, candidates);
  const DriveNoise noise(predictions.noise_drives());
  plan.refused = noise.refused();
  if (!plan.refused.empty()) return plan;
  if (!(fits.cost > 0)) plan.refused = "the recordings carry no noise";
  if (!plan.refused.empty()) return plan;
  Settling settling(predictions, noise, candidates.size(), threads, stop);
  const Vector before = settling.widths(settling.counts());
  std::vector<Eigen::Index> open;
  const auto name = [&](Eigen::Index i) {
    return predictions.parameters()[static_cast<std::size_t>(settling.at(i))].name;
  };
  for (Eigen::Index i = 0; i < before.size(); ++i)
    if (before[i] > kOpenShare) {
      open.push_back(i);
      plan.open.push_back(name(i));
    }
  if (open.empty()) return plan;
  const std::vector<std::size_t> order = choose(settling, open, stop);
  const Vector after = settling.widths(settling.counts());
  plan.largest_before = largest(before, open);
  plan.largest_after = largest(after, open);
  for (const std::size_t d : order)
    plan.drives.push_back({candidates[d].name, candidates[d].description, candidates[d].recorded,
                           1e-6 * static_cast<double>(candidates[d].recording.time_us.back()),
                           settling.counts()[d]});
  for (const Eigen::Index i : open)
    if (after[i] <= kOpenShare) plan.settled.push_back(name(i));
  return plan;
}

}  // namespace odobench
