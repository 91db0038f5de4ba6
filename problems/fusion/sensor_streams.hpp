// Synthetic sensors for recordings that have none: a camera with visual-inertial odometry and a gyro, made
// from the motion-capture truth with the errors that such devices have. Every stream that comes from here is
// synthetic; whoever shows results must say so.
//
// The truth between stamps is a straight line fitted by least squares to the stamps within +-smooth_s,
// evaluated at its middle, its slope the yaw rate: motion capture received over a network has stamps that
// jitter by 10 ms, whose differences would be no rates.
//
// Camera (like an Intel RealSense T265: odometry whose error grows with the way):
//     p_cam(t) = sum over frames of R(drift) (1 + scale) dp + walk_position + white,
//     theta_cam(t) = theta + walk_heading + white
// Gyro (like an InvenSense MPU6050): omega + bias + walk_bias + white, where bias is drawn once per
// recording. Stamps: frame k at (k + phase) / rate with a phase drawn per recording; arrival delay_s later; a
// sample is missing with the probability `missing`.
#pragma once

#include <cstdint>

#include "problems/fusion/fusion.hpp"

namespace odobench {

struct CameraErrors {
  double scale = 0;           // drawn per recording with this standard deviation around scale_mean
  double scale_mean = 0;      //
  double position_walk = 0;   // m per square root of a second
  double heading_walk = 0;    // rad per square root of a second
  double position_noise = 0;  // m, white
  double heading_noise = 0;   // rad, white
};

struct GyroErrors {
  double bias = 0;       // rad/s, standard deviation of the bias of a recording
  double bias_walk = 0;  // rad/s per square root of a second
  double noise = 0;      // rad/s, white, of a sample
};

struct StreamTiming {
  double rate_hz = 30;
  double delay_s = 0;
  double missing = 0;  // probability of a lost sample
  double smooth_s = 0.25;
};

// Throws std::invalid_argument naming the field unless: rate > 0, delay >= 0, 0 <= missing < 1, smooth > 0,
// errors finite and, except scale_mean, not negative.
std::vector<Measurement> synthetic_camera(const Recording& recording, const CameraErrors& errors,
                                          const StreamTiming& timing, std::uint64_t seed);
std::vector<Measurement> synthetic_gyro(const Recording& recording, const GyroErrors& errors,
                                        const StreamTiming& timing, std::uint64_t seed);

}  // namespace odobench
