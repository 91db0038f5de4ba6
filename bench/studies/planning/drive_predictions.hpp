// Drives that a user could make next, and where a model of the robot says that they end.
#pragma once

#include <string>
#include <vector>

#include "bench/studies/trust/model_fits.hpp"
#include "problems/information/discrimination.hpp"
#include "problems/simulation/robot_drives.hpp"
#include "problems/trust/odometry_noise.hpp"

namespace odobench {

struct DriveCandidate {
  std::string name, description;
  Recording recording;
  enum class Spin { None, All, Partly } spin = Spin::None;  // turns on the spot in it
  bool recorded = false;
};

// A drive as wheels report it that follow the nominal parameters' commands exactly, at 20 Hz, steered before
// it begins; signals of the kinds that `like` has; the reference is 0. Throws std::invalid_argument on a
// twist that the robot cannot do.
Recording commanded_recording(const Robot& robot, const RobotDrive& drive, const RobotAbilities& can,
                              const Recording& like);

// The trajectories of the recordings, as the first recording of each was driven, then known_drives() and
// small_circles() of the robot. Throws std::invalid_argument where the robot cannot drive.
std::vector<DriveCandidate> drive_candidates(const CalibrationProblem& plain, const Robot& robot);

// Candidates as drives of one model, fitted to the recordings of `plain` by fit_model(). Immutable; every
// member may be called from several threads.
class DrivePredictions {
 public:
  // A candidate all on the spot is of the kind of a speed_factor whose recordings turn on the spot.
  DrivePredictions(const CalibrationProblem& plain, const Robot& robot, const ModelFits& fits,
                   const std::vector<DriveCandidate>& candidates);

  // Whether the model says what this drive does: a factor on drives on the spot says nothing of those that
  // are partly so.
  bool knows(const DriveCandidate& candidate) const;
  PoseTrack track(std::size_t drive) const { return problem_.integrate(drive, z_); }
  // In the frame of the start: x, y, heading.
  Eigen::Vector3d end(std::size_t drive) const { return end_at(drive, z_); }
  // Derivative of it by all parameters, 3 x n: central differences; 0 for those that are held.
  Matrix end_jacobian(std::size_t drive) const;
  const Matrix& covariance() const { return covariance_; }  // fitted_covariance()
  const std::vector<ParameterInfo>& parameters() const { return problem_.parameters(); }
  // Of the recordings, by this model.
  const std::vector<NoiseDrive>& noise_drives() const { return noise_; }

 private:
  Eigen::Vector3d end_at(std::size_t drive, const Vector& z) const;

  Vector z_;
  bool kind_turns_ = false;
  CalibrationProblem problem_;
  Matrix covariance_;
  std::vector<NoiseDrive> noise_;
};

// The noise of drives that are yet to be made, from the errors of those that were. What these do not tell of
// turning counts as it does of travelling, a radian as a metre, and the other way round.
class DriveNoise {
 public:
  explicit DriveNoise(const std::vector<NoiseDrive>& drives);
  const std::string& refused() const { return fit_.refused; }  // why nothing is known; "" otherwise
  // Covariance of one drive's end (the odometry's noise and the reference's), at least 0.1 mm and 0.1 mrad.
  Eigen::Matrix3d scatter(const PoseTrack& track) const;
  // Of what repeats in all repetitions of a kind of drive, which no repetition averages out.
  Eigen::Matrix3d repeating(const PoseTrack& track) const;

 private:
  NoiseFit fit_;
  NoiseModel rest_;
};

}  // namespace odobench
