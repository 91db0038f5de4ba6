// Relative motions of drives, their errors, and how these depend on the noise: a private header of
// odometry_noise.cpp.
#pragma once

#include <array>
#include <vector>

#include "problems/trust/odometry_noise.hpp"

namespace odobench::noise {

// A drive in steps of 2 cm or 0.02 rad, between which the reference is looked up. Steps do not depend on the
// sampling: noise of single samples would make ways of |ds| and |dphi| that grow with the rate.
struct Path {
  std::vector<std::size_t> node;       // samples
  std::vector<std::size_t> reference;  // per node: row of the reference, kNone where there is none
  std::vector<double> progress;        // per node: metres + radians since the first
  double metres = 0, radians = 0;
};
inline constexpr std::size_t kNone = static_cast<std::size_t>(-1);
Path path_of(const NoiseDrive& drive);

// The error of the motion between two nodes: covariance sum of value[m] * basis[m].
struct Segment {
  std::size_t drive = 0;
  int level = 0;  // length, 0 the shortest
  int index = 0;  // along the drive
  double metres = 0, radians = 0;
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();  // by odometry, in the frame of its start
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  double weight = 1;
  std::array<Eigen::Matrix3d, kNoiseTerms> basis;
};
// `first`, `last`: nodes with a reference.
Segment segment_between(const NoiseDrive& drive, const Path& path, std::size_t first, std::size_t last);

// The path cut into `parts` equal ones by progress, at the nearest nodes with a reference; parts of no length
// are left out, but keep their index.
std::vector<Segment> cut(const NoiseDrive& drive, const Path& path, int parts);

// Covariance of a segment.
Eigen::Matrix3d covariance_of(const NoiseModel& model, const Segment& segment);

// Mean of `metres` over the time that they took, in steps that travel (turn).
TypicalMotion typical_motion(const std::vector<NoiseDrive>& drives, const std::vector<Path>& paths);

}  // namespace odobench::noise
