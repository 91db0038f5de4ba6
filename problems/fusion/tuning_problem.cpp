#include "problems/fusion/tuning_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace odobench {
namespace {

constexpr double kDecades = 2;
constexpr double kStep = 1e-4;

// Calls f(name, sigma) for every sigma of options and sensors in the order of the parameters.
template <class Options, class Sensors, class F>
void for_each_sigma(Options& options, Sensors& sensors, F f) {
  f("wheels.velocity", options.sigma_velocity);
  f("wheels.yaw_rate", options.sigma_yaw_rate);
  for (auto& s : sensors) {
    if (s.kind == SensorKind::YawRate) {
      f(s.name + ".yaw_rate", s.sigma_rate);
      continue;
    }
    if (s.kind != SensorKind::Heading) f(s.name + ".position", s.sigma_position);
    f(s.name + ".heading", s.sigma_heading);
  }
}

}  // namespace

FusionTuningProblem::FusionTuningProblem(std::shared_ptr<const std::vector<Recording>> recordings,
                                         Vector wheels, std::vector<std::vector<SensorStream>> streams,
                                         FusionOptions options, TuningObjective objective)
    : recordings_(std::move(recordings)),
      wheels_(std::move(wheels)),
      streams_(std::move(streams)),
      options_(std::move(options)),
      objective_(objective) {
  if (recordings_->empty() || streams_.size() != recordings_->size())
    throw std::invalid_argument(fmt::format("tuning: streams for {} recordings, expected {} and at least 1",
                                            streams_.size(), recordings_->size()));
  options_.smooth = false;
  if (objective_ == TuningObjective::Likelihood) options_.gate_probability = 0;
  validate(options_, streams_.front());
  for_each_sigma(options_, streams_.front(), [&](const std::string& name, double sigma) {
    const double at = std::log10(sigma);
    parameters_.push_back({"log10 " + name, "1", at, at - kDecades, at + kDecades});
  });
  // The number of residuals does not depend on the sigmas: every measurement in time is used once.
  Vector x(static_cast<Eigen::Index>(parameters_.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = parameters_[static_cast<std::size_t>(i)].nominal;
  for (std::size_t k = 0; k < recordings_->size(); ++k) {
    if (objective_ == TuningObjective::Error) {
      rows_ += 3 * static_cast<Eigen::Index>((*recordings_)[k].size());
      continue;
    }
    const FusionResult result = fuse((*recordings_)[k], wheels_, streams_[k], options_, true);
    rows_ += static_cast<Eigen::Index>(result.whitened.size() + result.log_dets.size());
  }
  // The lowest log det of any sensor's innovation within the box, less 1.
  double lowest = 0;
  for (const SensorStream& s : streams_.front()) {
    const double rate = std::log(s.sigma_rate), position = std::log(s.sigma_position),
                 angle = std::log(s.sigma_heading);
    const double span = kDecades * std::log(10.0);
    const double least = s.kind == SensorKind::YawRate   ? 2 * (rate - span)
                         : s.kind == SensorKind::Heading ? 2 * (angle - span)
                                                         : 2 * (2 * position + angle - 3 * span);
    lowest = std::min(lowest, least);
  }
  offset_ = 1 - lowest;
}

void FusionTuningProblem::apply(const ConstVectorRef& x, FusionOptions& options,
                                std::vector<SensorStream>& sensors) const {
  Eigen::Index i = 0;
  for_each_sigma(options, sensors,
                 [&](const std::string&, double& sigma) { sigma = std::pow(10.0, x[i++]); });
}

void FusionTuningProblem::residuals(const ConstVectorRef& x, VectorRef r) const {
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < recordings_->size(); ++k) {
    FusionOptions options = options_;
    std::vector<SensorStream> streams = streams_[k];
    apply(x, options, streams);
    const Recording& recording = (*recordings_)[k];
    const FusionResult result =
        fuse(recording, wheels_, streams, options, objective_ == TuningObjective::Likelihood);
    if (objective_ == TuningObjective::Error) {
      for (std::size_t i = 0; i < recording.size(); ++i, row += 3)
        r.segment<3>(row) << result.track.x[i] - recording.reference.x[i],
            result.track.y[i] - recording.reference.y[i],
            result.track.theta[i] - recording.reference.theta[i];
      continue;
    }
    for (const double w : result.whitened) r[row++] = w;
    for (const double d : result.log_dets) r[row++] = std::sqrt(d + offset_);
  }
}

double FusionTuningProblem::cost(const ConstVectorRef& x) const {
  Vector r(rows_);
  residuals(x, r);
  return r.squaredNorm();
}

void FusionTuningProblem::residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
  residuals(x, r);
  Vector up(rows_), down(rows_);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Vector shifted = x;
    shifted[i] = x[i] + kStep;
    residuals(shifted, up);
    shifted[i] = x[i] - kStep;
    residuals(shifted, down);
    j.col(i) = (up - down) / (2 * kStep);
  }
}

}  // namespace odobench
