// How far a drive by odometry is from its reference, in the plane: the four figures of Sousa et al., J.
// Intell. Robot. Syst. 105:39 (2022), and the end error that UMBmark is about.
#pragma once

#include "problems/calibration/calibration_problem.hpp"

namespace odobench {

struct DriveErrors {
  double max_position = 0, max_heading = 0;  // m, rad: over the samples with a reference
  double end_position = 0, end_heading = 0;  // at the last of them
  double rms_position = 0, rms_heading = 0;  // m, rad: over the samples with a reference but the first
  std::size_t samples = 0;                   // of these
  // Reference minus odometry at the last of them, in the frame of the reference's first pose (of the
  // odometry's where there is none at the start): m, m, rad in (-pi, pi].
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
};

// `track`: of every sample. Headings are compared as they are where there is a reference everywhere, else up
// to turns.
DriveErrors drive_errors(const Recording& recording, const PoseTrack& track);

// 1 counter-clockwise, -1 clockwise, 0 where the track turns by less than a quarter turn altogether.
int sense_of(const PoseTrack& track);

// J of any poses of the samples, one track per recording, by the rows, cost and weights of the problem, whose
// mount is not looked at. Throws std::invalid_argument for a structured problem, which has no rows.
double cost_of_tracks(const CalibrationProblem& problem, const std::vector<PoseTrack>& tracks);

}  // namespace odobench
