// The noise of a calibrated odometry itself: what a filter should believe of it.
//
// Model: over a small motion of ds metres and dphi radians the odometry errs by a white increment in the body
// frame, independent of all others, whose covariance is linear in both (in direction of travel t and across
// it n, in directions x and y of the body, in heading h):
//     Q = |ds|   (along tt' + across nn' + heading hh'
//                 + along_heading (th' + ht') + across_heading (nh' + hn'))
//       + |dphi| (forward xx' + sideways yy' + turn hh'
//                 + forward_turn (xh' + hx') + sideways_turn (yh' + hy'))
// An error of the heading turns the rest of the path, so the covariance of a relative motion is the sum of
// F Q F' along the path, F = [1 0 -ry; 0 1 rx; 0 0 1] with the lever r from the increment to the end: the
// linearised propagation of K. S. Chong, L. Kleeman (ICRA 1997) and A. Kelly (IJRR 23(2), 2004); increments
// with variances linear in the motion are those of A. Martinelli (IEEE T-RO 18(4), 2002). S. Thrun, W.
// Burgard, D. Fox, Probabilistic Robotics (2005), 5.4 takes standard deviations linear in the motion of an
// update instead: such a noise depends on how often one updates (amcl_alphas()).
//
// The reference errs, too: white noise at both ends of a motion (position, heading) and a white error of its
// stamp, which acts along the velocity. They are fitted beside Q, so that they do not count as wheels'.
//
// What repeats in all repetitions of a kind of drive is no noise: errors are taken relative to the mean over
// the repetitions at the same share of the path, which is reported apart (NoiseKind::bias).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "problems/calibration/calibration_problem.hpp"

namespace odobench {

// Indices of NoiseModel::value.
enum NoiseTerm : int {
  kAlong,
  kAcross,
  kHeading,  // m^2/m, m^2/m, rad^2/m
  kForward,
  kSideways,
  kTurn,  // m^2/rad, m^2/rad, rad^2/rad
  kCapturePosition,
  kCaptureHeading,
  kCaptureStamp,  // m^2, rad^2, s^2: of the reference
  kAlongHeading,
  kAcrossHeading,  // m rad/m
  kForwardTurn,
  kSidewaysTurn,  // m rad/rad
  kNoiseTerms
};
inline constexpr int kNoiseVariances = 9;  // the first ones, not negative

struct NoiseTermInfo {
  const char* name;     // "along_per_metre"
  const char* unit;     // of the variance, "m^2/m"
  const char* meaning;  // a few words
};
const std::array<NoiseTermInfo, kNoiseTerms>& noise_terms();

// Speeds at which the drives were driven: metres and radians over the time in which there were such.
struct TypicalMotion {
  double speed = 0, turn_rate = 0;  // m/s, rad/s
};

struct NoiseModel {
  std::array<double, kNoiseTerms> value{};
  // Covariances per metre in directions (along, across, heading), per radian in (forward, sideways, heading).
  Eigen::Matrix3d per_metre() const;
  Eigen::Matrix3d per_radian() const;
  // In the body frame for a motion of (dx, dy, dphi) in it: Q above.
  Eigen::Matrix3d increment(double dx, double dy, double dphi) const;
};

// A recording as the estimation takes it: odometry at every sample, the reference at `rows`, both of the
// body's own frame (a mount that was calibrated is taken away).
struct NoiseDrive {
  std::string id, trajectory;
  std::vector<double> time_s;
  PoseTrack odometry;
  std::vector<std::size_t> rows;
  PoseTrack reference;  // one entry per row
};
// Of every recording with the parameters z of the problem.
std::vector<NoiseDrive> noise_drives(const CalibrationProblem& problem, const ConstVectorRef& z);

// What is known of one number of the model.
struct NoiseEstimate {
  double value = 0;
  double lower = 0, upper = 0;  // 95 %; see NoiseFit
  std::string undetermined;     // why the drives do not tell it; then it is 0
};

// A kind of drive: what repeats in it, and whether the noise explains what does not.
struct NoiseKind {
  std::string trajectory;
  int drives = 0;
  bool repeated = false;                           // else nothing can be told apart and bias is 0
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  // mean error of the end, odometry minus reference, m, m,
                                                   // rad, in the frame of the start
  Eigen::Vector3d scatter = Eigen::Vector3d::Zero();    // standard deviation over the repetitions
  Eigen::Vector3d predicted = Eigen::Vector3d::Zero();  // that of the model, reference's noise included
  double nees = 0;  // mean of the left-out drives, 3 expected; not-a-number without
};

// How the errors of relative motions of one length compare with the model: 1 for white increments, growing
// with the length where they are correlated.
struct NoiseLength {
  double metres = 0, radians = 0;  // mean of the segments
  int segments = 0;
  double ratio = 0;  // mean NEES / 3
};

struct NoiseFit {
  std::string refused;  // why there is none; everything below is empty then
  NoiseModel model;
  std::array<NoiseEstimate, kNoiseTerms> terms;
  TypicalMotion typical;
  std::vector<NoiseKind> kinds;
  std::vector<NoiseLength> lengths;
  int drives = 0, segments = 0;
  // Segments whose NEES is beyond the 99.9 % quantile and counts as that, and those left out since they lie
  // eight standard deviations from the median of the repetitions.
  int held_back = 0;
  bool separated = false;  // whether any kind is repeated, so that systematic rest and noise are apart
  double metres = 0, radians = 0;  // driven and turned altogether
  // Left-out drives (leave one repetition out): end poses, each against the bias and the noise of the others.
  // nees is 3 where all is right; the band is that of an F distribution (degrees of freedom of the drives, of
  // the estimated covariance). checked 0: there was nothing to leave out.
  int checked = 0;
  double nees = 0, nees_lower = 0, nees_upper = 0;
  bool consistent() const { return checked > 0 && nees >= nees_lower && nees <= nees_upper; }
};

struct NoiseOptions {
  bool intervals = true;  // else lower = upper = value
  bool check = true;      // left-out drives
  // Takes all errors for noise, what repeats too: what a filter has to believe that has no state for it.
  bool with_bias = false;
};

// Fits the model to the drives. Segments: each drive's path (metres + radians) is cut into 2^k equal parts of
// at least 0.25 (m + rad), at most 128, and into halves, quarters and eighths of that number; the error of
// each part is odometry minus reference in the frame of its beginning. Variances by Fisher scoring of the
// Gaussian likelihood of all parts (not negative: active sets), which needs no start; the parts of different
// length are not independent, so it is a composite likelihood (Varin, Reid, Firth, Statistica Sinica 21,
// 2011) and its own curvature is no precision: intervals are those of a delete-one jackknife over drives (60
// groups of them at most), t with drives minus kinds degrees of freedom, on the logarithm of variances.
//
// refused: fewer than kFewestDrives drives with a reference at two places that move, or fewer than
// kFewestFree degrees of freedom (drives minus repeated kinds). Deterministic.
inline constexpr int kFewestDrives = 4, kFewestFree = 3;
NoiseFit fit_odometry_noise(const std::vector<NoiseDrive>& drives, const NoiseOptions& options = {});

// The model for a filter: a variance that came out as 0 is taken at its upper bound, since no filter may
// believe anything for certain; the reference's noise is left out. Needs a fit with intervals.
NoiseModel believable(const NoiseFit& fit);

// Covariance of the motion from the first to the last of these poses, in the frame of the first: of the
// odometry alone, without the reference's noise.
Eigen::Matrix3d propagated_noise(const NoiseModel& model, const PoseTrack& poses);

// Variances of the twist (vx, vy, omega) that a filter should believe which takes one sample every `period_s`
// for white: Q of the motion of a period, divided by its square.
Eigen::Matrix3d twist_covariance(const NoiseModel& model, double vx, double vy, double omega,
                                 double period_s);

// alpha1..alpha5 of amcl for updates every `distance` m and `angle` rad (its update_min_d, update_min_a),
// whose variances go with the square of the motion: those that agree with the model at such an update.
// Differential model: rotations before and after a translation share alpha2. Omnidirectional model: alpha1 is
// translation by turning, alpha4 turning by turning, alpha5 strafing by translation.
std::array<double, 5> amcl_alphas(const NoiseModel& model, bool omnidirectional, double distance,
                                  double angle);

}  // namespace odobench
