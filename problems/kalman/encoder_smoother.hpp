// A linear Kalman filter and fixed-lag smoother over the encoders, accelerometer and gyro that the
// relative-entropy filter takes, on the model of its windows (T. Stirblys, Kaunas 2015, (2.20)-(2.28)):
//     s(n+1) = s(n) + dt^2 a(n),   a(n+1) = a(n) + w_a           x and y of the filter's frame
//     r(n+1) = r(n) + (dt^2 / k) w_r                              rotation as wheel displacement, k in deg/m
// with measurements X(n)/4 of s (deviation sigma_e/2), the acceleration of a (sigma_a), and of r the weighted
// mean of encoders and gyro, variance 1/(4/sigma_e^2 + k^2/sigma_theta^2). Where the relative-entropy filter
// allows increments -step, 0, step and charges nothing for them, w is white with the deviation of that choice
// made at random, step sqrt(2/3). docs/entropy_filter.md says what the two have in common.
#pragma once

#include <optional>

#include "problems/entropy/profile_form.hpp"
#include "problems/kalman/fixed_lag_smoother.hpp"

namespace odobench {

// Of -1, 0, 1 with equal probability: sqrt(2/3).
inline constexpr double kTernaryDeviation = 0.81649658092772603;

struct MotionEstimate {
  EntropyState state;        // sx, sy, r of the sample; ax12, ay12 are the accelerations at it
  EntropyPrediction wheels;  // of these (2.24)-(2.28)
};

// One axis: a displacement per step and the acceleration that changes it.
class AxisSmoother {
 public:
  // `time_squared` dt^2; deviations of a measured displacement, a measured acceleration and an increment
  // (may be 0: the acceleration is constant).
  AxisSmoother(double time_squared, double sigma_displacement, double sigma_acceleration,
               double sigma_increment, int lag);
  // A sample; the first needs both (they are the first estimate: nothing is known before), later ones may
  // have no acceleration. Returns the normalised innovation squared, 0 for the first.
  double push(double displacement, std::optional<double> acceleration);

  struct Value {
    double displacement = 0, acceleration = 0;
  };
  Value filtered() const;
  Value smoothed() const;  // `lag` samples back, or the first

 private:
  double time_squared_;
  Eigen::Vector2d sigma_;
  double increment_;
  int lag_;
  std::optional<FixedLagSmoother<2, 1>> smoother_;
};

class EncoderSmoother {
 public:
  // Constants as of the filter; lag = samples - 1. The profile outlives it.
  explicit EncoderSmoother(const ProfileForm& profile);

  void push(const EntropySample& sample);
  MotionEstimate filtered() const;
  MotionEstimate smoothed() const;  // samples - 1 back, or of the first sample

 private:
  MotionEstimate estimate(const AxisSmoother::Value& x, const AxisSmoother::Value& y, double r) const;

  ModeReader reader_;
  Predictor predictor_;
  AxisSmoother x_, y_;
  double rotation_sigma_, rotation_increment_;  // of r [m]
  int lag_;
  std::optional<FixedLagSmoother<1, 1>> r_;
};

}  // namespace odobench
