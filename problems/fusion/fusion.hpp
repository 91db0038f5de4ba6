// Wheel odometry fused with a camera's pose and a gyro over one recording: measurements of any rate, delayed
// or missing, in the order of their stamps, through the filters of kalman_filter.hpp; chapter 4 of J. Vitko's
// thesis, with the innovation against the predicted state. The wheels' twist drives the prediction between
// stamps.
//
// Noise of the wheels and the gyro is white: a sample that holds for h seconds and is used for a part dt of
// it gets its variance times h/dt there, so that cutting an interval at another sensor's stamp changes
// nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "problems/calibration/calibration_problem.hpp"
#include "problems/kalman/kalman_filter.hpp"
#include "problems/trust/odometry_noise.hpp"

namespace odobench {

enum class SensorKind {
  Pose,          // (x, y, theta) in the world
  Heading,       // theta only
  RelativePose,  // as Pose, but only the motion since the sample before is used: drift does not accumulate in it
  YawRate        // omega, value[0]
};

struct Measurement {
  std::int64_t time_us = 0;     // when it was true
  std::int64_t arrival_us = 0;  // when the filter gets to know it, >= time_us
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

// Standard deviations are what the filter believes, of one sample.
struct SensorStream {
  std::string name;
  SensorKind kind = SensorKind::Pose;
  double sigma_position = 0;      // m (Pose, RelativePose)
  double sigma_heading = 0;       // rad (Pose, Heading, RelativePose)
  double sigma_rate = 0;          // rad/s (YawRate)
  double hold_s = 0;              // YawRate: how long a sample holds unless the next one comes first
  std::vector<Measurement> data;  // strictly increasing time_us
};

// A further state with its standard deviation at the start and its random walk per square root of a second.
struct WalkingState {
  double initial = 0;
  double walk = 0;
};

inline constexpr double kLeastWheelSigma = 1e-6;  // m/s, rad/s

struct FusionOptions {
  KalmanOptions filter;
  double sigma_velocity = 0.01;  // of the wheels' twist, one sample: m/s in x and in y,
  double sigma_yaw_rate = 0.02;  // rad/s
  // Instead of these two: variances linear in the motion of a sample. kLeastWheelSigma is added to all three,
  // so that a robot at rest keeps a covariance that has an inverse.
  std::optional<NoiseModel> wheel_noise;
  double initial_position = 1e-3;  // standard deviations of the start, m and rad
  double initial_heading = 1e-3;
  std::optional<WalkingState> gyro_bias;       // rad/s
  std::optional<WalkingState> odometry_scale;  // of the translation, 1
  double gate_probability = 0;  // measurements whose NIS is beyond this quantile are rejected; 0: none are
  double max_delay_s = 1;       // later ones are counted and not used
  bool smooth = false;          // also run backwards (Rauch, Tung, Striebel 1965), with every measurement
};

struct SensorStatistics {
  std::string name;
  int dof = 0;
  std::int64_t used = 0, rejected = 0, late = 0, outside = 0;  // outside: of the recording's time
  double mean_nis = 0;                                         // of the used and the rejected ones
  double mean_innovation = 0;  // YawRate: of the same, gyro minus wheels, rad/s
  double log_likelihood = 0;   // of the used ones, sum of -(nis + log det S + dof log 2 pi) / 2
};

struct FusionResult {
  PoseTrack track;  // after every measurement that had arrived by each stamp of the recording
  std::vector<Eigen::Matrix3d> factors;  // lower triangular, of the pose's covariance
  PoseTrack smoothed;                    // with `smooth`
  std::vector<Eigen::Matrix3d> smoothed_factors;
  std::vector<SensorStatistics> sensors;
  std::optional<double> gyro_bias, odometry_scale;  // at the end
  // Whitened innovations and log det S + dof log 2 pi of the used measurements, in the order of use; on
  // request.
  std::vector<double> whitened, log_dets;
};

// Throws std::invalid_argument naming the field, its value and what was expected: sigmas that are not finite
// and positive (initial and walk: not negative), a probability outside [0, 1), two yaw-rate or two relative
// streams, the smoother with relative poses, a gyro bias without a gyro, two sensors of one name.
void validate(const FusionOptions& options, std::span<const SensorStream> sensors);

// z: twelve parameters as in calibration_problem.hpp. Starts at (0, 0, theta_ref[0]). Throws as validate
// does, and std::runtime_error about data: a sensor without a single measurement in the recording's time,
// stamps that do not increase, an arrival before its stamp, values that are not finite. With
// `keep_innovations` the last two fields of the result are filled.
FusionResult fuse(const Recording& recording, const ConstVectorRef& z, std::span<const SensorStream> sensors,
                  const FusionOptions& options, bool keep_innovations = false);

// How far a track is from the reference, and whether its covariance says so.
struct TrackErrors {
  MaxErrors max;
  double rmse_position = 0, rmse_heading = 0;
  // At kGrid equal fractions of the recording: e' P^-1 e of the pose, and e_i^2 / P_ii of x, y, theta.
  static constexpr std::size_t kGrid = 100;
  std::vector<double> nees;
  std::vector<Eigen::Vector3d> component_nees;
};
// `factors` empty: no NEES.
TrackErrors track_errors(const Recording& recording, const PoseTrack& track,
                         const std::vector<Eigen::Matrix3d>& factors);

}  // namespace odobench
