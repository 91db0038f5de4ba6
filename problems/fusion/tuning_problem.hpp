// A filter's noise parameters as a problem for any solver. Parameters: log10 of the standard deviations that
// the filter believes, each within a factor of 100 of the given one: wheels.velocity, wheels.yaw_rate, and
// per sensor NAME.position, NAME.heading or NAME.yaw_rate.
//
// Costs, sums over the recordings, as squares of residuals, so that least-squares methods apply:
//     likelihood   sum over the innovations of nu' S^-1 nu + log det S + c,   residuals: L^-1 nu and sqrt(log
//                  det S + c) c makes every log det positive: S >= R, and R has its lowest determinant at the
//                  lower bounds. Twice the negative log likelihood up to a constant. Gates are off: rejecting
//                  would reward small sigmas.
//     error        sum of (x-x_ref)^2 + (y-y_ref)^2 + (theta-theta_ref)^2 over the samples, as the cost of
//                  the calibration
// The Jacobian is by central differences of 1e-4 in log10.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "problems/fusion/fusion.hpp"

namespace odobench {

enum class TuningObjective { Likelihood, Error };

class FusionTuningProblem {
 public:
  // `streams` per recording, the same sensors in the same order. Throws std::invalid_argument on no
  // recordings, another number of streams, or options that fuse() refuses; std::runtime_error on bad data.
  FusionTuningProblem(std::shared_ptr<const std::vector<Recording>> recordings, Vector wheels,
                      std::vector<std::vector<SensorStream>> streams, FusionOptions options,
                      TuningObjective objective);

  std::string name() const { return "fusion-tuning"; }
  const std::vector<ParameterInfo>& parameters() const { return parameters_; }
  double cost(const ConstVectorRef& x) const;
  Eigen::Index residual_count() const { return rows_; }
  void residuals(const ConstVectorRef& x, VectorRef r) const;
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const;

  // The options and sigmas that x means; `sensors` as given to the constructor.
  void apply(const ConstVectorRef& x, FusionOptions& options, std::vector<SensorStream>& sensors) const;

 private:
  std::shared_ptr<const std::vector<Recording>> recordings_;
  Vector wheels_;
  std::vector<std::vector<SensorStream>> streams_;
  FusionOptions options_;
  TuningObjective objective_;
  std::vector<ParameterInfo> parameters_;
  double offset_ = 0;  // c
  Eigen::Index rows_ = 0;
};

}  // namespace odobench
