#include "problems/kalman/encoder_smoother.hpp"

#include <cmath>
#include <stdexcept>

namespace odobench {

using Scalar = Eigen::Matrix<double, 1, 1>;

AxisSmoother::AxisSmoother(double time_squared, double sigma_displacement, double sigma_acceleration,
                           double sigma_increment, int lag)
    : time_squared_(time_squared),
      sigma_(sigma_displacement, sigma_acceleration),
      increment_(sigma_increment),
      lag_(lag) {}

double AxisSmoother::push(double displacement, std::optional<double> acceleration) {
  if (!smoother_) {
    if (!acceleration) throw std::invalid_argument("smoother: the first sample needs an acceleration");
    ConstantModel<2, 1> model;
    model.f << 1, time_squared_, 0, 1;
    model.g << 0, 1;
    smoother_.emplace(model, Scalar::Constant(increment_), lag_, Eigen::Vector2d(displacement, *acceleration),
                      Eigen::Matrix2d(sigma_.array().square().matrix().asDiagonal().toDenseMatrix()));
    return 0;
  }
  smoother_->predict();
  if (acceleration) return smoother_->update<2>(Eigen::Vector2d(displacement, *acceleration), sigma_);
  return smoother_->update<1>(Scalar::Constant(displacement), Scalar::Constant(sigma_[0]));
}

AxisSmoother::Value AxisSmoother::filtered() const {
  const Eigen::Vector2d& x = smoother_.value().filtered();
  return {x[0], x[1]};
}

AxisSmoother::Value AxisSmoother::smoothed() const {
  const Eigen::Vector2d x = smoother_.value().smoothed();
  return {x[0], x[1]};
}

namespace {

AxisSmoother axis(const EntropyConstants& c) {
  return AxisSmoother(c.dt * c.dt, c.sigma_encoder / 2, c.sigma_acceleration,
                      kTernaryDeviation * c.step_acceleration, c.samples - 1);
}

// Of r [m]: the weighted mean of encoders and gyro.
double rotation_deviation(const EntropyConstants& c) {
  const double k = degrees_per_metre(c);
  return 1 /
         std::sqrt(4 / (c.sigma_encoder * c.sigma_encoder) + k * k / (c.sigma_rotation * c.sigma_rotation));
}

}  // namespace

EncoderSmoother::EncoderSmoother(const ProfileForm& profile)
    : reader_(profile),
      predictor_(profile.constants()),
      x_(axis(profile.constants())),
      y_(axis(profile.constants())),
      rotation_sigma_(rotation_deviation(profile.constants())),
      rotation_increment_(kTernaryDeviation * profile.constants().step_rotation * profile.constants().dt *
                          profile.constants().dt / degrees_per_metre(profile.constants())),
      lag_(profile.constants().samples - 1) {}

void EncoderSmoother::push(const EntropySample& sample) {
  const SampleModes modes = reader_.read(sample);
  x_.push(modes.x / 4, sample.ax);
  y_.push(modes.y / 4, sample.ay);
  if (r_) {
    r_->predict();
    r_->update<1>(Scalar::Constant(modes.rho), Scalar::Constant(rotation_sigma_));
  } else {
    r_.emplace(ConstantModel<1, 1>{Scalar::Identity(), Scalar::Identity()},
               Scalar::Constant(rotation_increment_), lag_, Scalar::Constant(modes.rho),
               Scalar::Constant(rotation_sigma_ * rotation_sigma_));
  }
}

MotionEstimate EncoderSmoother::estimate(const AxisSmoother::Value& x, const AxisSmoother::Value& y,
                                         double r) const {
  return {{r, x.displacement, y.displacement, x.acceleration, y.acceleration},
          predictor_.predict(x.displacement, y.displacement, r)};
}

MotionEstimate EncoderSmoother::filtered() const {
  return estimate(x_.filtered(), y_.filtered(), r_.value().filtered()[0]);
}

MotionEstimate EncoderSmoother::smoothed() const {
  return estimate(x_.smoothed(), y_.smoothed(), r_.value().smoothed()[0]);
}

}  // namespace odobench
