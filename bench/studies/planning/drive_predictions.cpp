#include "bench/studies/planning/drive_predictions.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "problems/simulation/robot_simulator.hpp"

namespace odobench {
namespace {

constexpr std::int64_t kStep_us = 50'000;
// No end pose is believed better than this, m and rad.
constexpr double kLeastScatter = 1e-4;

bool turns_on_the_spot(const Recording& r) {
  double path = 0, turned = 0;
  for (std::size_t k = 1; k < r.reference.x.size(); ++k) {
    path =
        std::max(path, std::hypot(r.reference.x[k] - r.reference.x[0], r.reference.y[k] - r.reference.y[0]));
    turned = std::max(turned, std::abs(r.reference.theta[k] - r.reference.theta[0]));
  }
  return turned > 1 && path < 0.05 * turned;
}

// Whether there are recordings of this kind, and all of them turn on the spot.
bool kind_turns(const std::vector<Recording>& recordings, const std::string& kind) {
  return !kind.empty() && std::all_of(recordings.begin(), recordings.end(), [&](const Recording& r) {
    return r.trajectory.rfind(kind, 0) != 0 || turns_on_the_spot(r);
  });
}

CalibrationProblem problem_of(const CalibrationProblem& plain, const Robot& robot, const ModelFits& fits,
                              const std::vector<DriveCandidate>& candidates, bool kind_turns) {
  std::vector<Recording> recordings;
  for (const DriveCandidate& c : candidates) {
    recordings.push_back(c.recording);
    if (c.spin == DriveCandidate::Spin::All && kind_turns)
      recordings.back().trajectory = fits.terms.speed_factor_of;
  }
  CalibrationOptions options = plain.options();
  options.model = fits.terms;
  return {robot, std::move(recordings), options, plain.kernel()};
}

DriveCandidate::Spin spin_of(const RobotDrive& drive) {
  const auto spins = std::count_if(drive.phases.begin(), drive.phases.end(), [](const RobotPhase& p) {
    return p.vx == 0 && p.vy == 0 && p.omega != 0;
  });
  if (spins == 0) return DriveCandidate::Spin::None;
  return spins == static_cast<std::ptrdiff_t>(drive.phases.size()) ? DriveCandidate::Spin::All
                                                                   : DriveCandidate::Spin::Partly;
}

// Drives that never turned tell no noise of turning, and the other way round: a radian counts as a metre.
void fill_gaps(const std::array<NoiseEstimate, kNoiseTerms>& terms, NoiseModel& model) {
  constexpr std::array<std::pair<NoiseTerm, NoiseTerm>, 3> kAlike{
      {{kAlong, kForward}, {kAcross, kSideways}, {kHeading, kTurn}}};
  for (const auto& [metre, radian] : kAlike) {
    if (!terms[radian].undetermined.empty()) model.value[radian] = model.value[metre];
    if (!terms[metre].undetermined.empty()) model.value[metre] = model.value[radian];
  }
}

}  // namespace

Recording commanded_recording(const Robot& robot, const RobotDrive& drive, const RobotAbilities& can,
                              const Recording& like) {
  const robots::WheeledRobot model(robot.table);
  const Vector z = nominal_values(robot);
  const Matrix twists = twists_of(drive, can);
  const Eigen::Index intervals = twists.cols(), drives = model.drive_count();
  Vector held;
  for (Eigen::Index k = 0; k < intervals && held.size() == 0; ++k)
    if (twists.col(k).norm() > 0) held = model.inverse(twists.col(k), z);
  Recording r;
  r.id = r.trajectory = drive.name;
  r.repetition = 1;
  const auto count = static_cast<std::size_t>(intervals) + 1;
  for (std::size_t k = 0; k < count; ++k) r.time_us.push_back(kStep_us * static_cast<std::int64_t>(k));
  r.reference.x = r.reference.y = r.reference.theta = std::vector<double>(count, 0.0);
  bool speeds = true;
  for (Eigen::Index i = 0; i < drives; ++i)
    if (const Signal* s = like.find(model.signals()[static_cast<std::size_t>(i)]))
      speeds = speeds && s->kind == SignalKind::Speed;
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(model.signals().size()); ++i) {
    const SignalKind kind = i >= drives ? SignalKind::Angle
                            : speeds    ? SignalKind::Speed
                                        : SignalKind::Increment;
    r.signals.push_back({model.signals()[static_cast<std::size_t>(i)], kind, std::vector<double>(count, 0)});
  }
  for (Eigen::Index k = 0; k < intervals; ++k) {
    held = model.inverse(twists.col(k), z, held);
    const auto row = static_cast<std::size_t>(speeds ? k : k + 1);
    for (Eigen::Index i = 0; i < held.size(); ++i)
      r.signals[static_cast<std::size_t>(i)].values[row] =
          i < drives && !speeds ? kRobotStep * held[i] : held[i];
  }
  for (Eigen::Index i = drives; i < held.size(); ++i) {  // the row that no interval has
    std::vector<double>& angles = r.signals[static_cast<std::size_t>(i)].values;
    if (speeds)
      angles.back() = angles[count - 2];
    else
      angles.front() = angles[1];
  }
  return r;
}

std::vector<DriveCandidate> drive_candidates(const CalibrationProblem& plain, const Robot& robot) {
  std::vector<DriveCandidate> list;
  std::set<std::string> names;
  for (const Recording& r : plain.recordings())
    if (names.insert(r.trajectory).second)
      list.push_back({r.trajectory, "as it was recorded", r, DriveCandidate::Spin::None, true});
  const RobotAbilities can = RobotSimulator(robot).abilities(nominal_values(robot));
  std::vector<RobotDrive> drives = known_drives(can);
  for (RobotDrive& d : small_circles(can)) drives.push_back(std::move(d));
  for (const RobotDrive& d : drives) {
    if (!names.insert(d.name).second) continue;
    list.push_back({d.name, d.description, commanded_recording(robot, d, can, plain.recordings().front()),
                    spin_of(d), false});
  }
  return list;
}

DrivePredictions::DrivePredictions(const CalibrationProblem& plain, const Robot& robot, const ModelFits& fits,
                                   const std::vector<DriveCandidate>& candidates)
    : z_(fits.z),
      kind_turns_(kind_turns(plain.recordings(), fits.terms.speed_factor_of)),
      problem_(problem_of(plain, robot, fits, candidates, kind_turns_)) {
  CalibrationOptions options = plain.options();
  options.model = fits.terms;
  const CalibrationProblem fitted(robot, plain.recordings(), options, plain.kernel());
  covariance_ =
      fitted_covariance(RecordingCosts(robot, plain.recordings(), options, plain.kernel()), fitted, z_);
  noise_ = odobench::noise_drives(fitted, z_);
}

bool DrivePredictions::knows(const DriveCandidate& candidate) const {
  return !kind_turns_ || candidate.spin != DriveCandidate::Spin::Partly;
}

Eigen::Vector3d DrivePredictions::end_at(std::size_t drive, const Vector& z) const {
  const PoseTrack t = problem_.integrate(drive, z);
  const double c = std::cos(t.theta.front()), s = std::sin(t.theta.front());
  const double dx = t.x.back() - t.x.front(), dy = t.y.back() - t.y.front();
  return {c * dx + s * dy, -s * dx + c * dy, t.theta.back() - t.theta.front()};
}

Matrix DrivePredictions::end_jacobian(std::size_t drive) const {
  Matrix jacobian = Matrix::Zero(3, z_.size());
  for (Eigen::Index i = 0; i < z_.size(); ++i) {
    const ParameterInfo& p = parameters()[static_cast<std::size_t>(i)];
    const double step = 1e-4 * (p.upper - p.lower);
    if (!(step > 0)) continue;
    Vector above = z_, below = z_;
    above[i] += step;
    below[i] -= step;
    jacobian.col(i) = (end_at(drive, above) - end_at(drive, below)) / (2 * step);
  }
  return jacobian;
}

DriveNoise::DriveNoise(const std::vector<NoiseDrive>& drives)
    : fit_(fit_odometry_noise(drives, {false, false, false})) {
  if (!fit_.refused.empty()) return;
  NoiseModel total = fit_.model;
  if (fit_.separated) total = fit_odometry_noise(drives, {false, false, true}).model;
  fill_gaps(fit_.terms, fit_.model);
  fill_gaps(fit_.terms, total);
  for (std::size_t t = 0; t < static_cast<std::size_t>(kCapturePosition); ++t)
    rest_.value[t] = std::max(0.0, total.value[t] - fit_.model.value[t]);
}

Eigen::Matrix3d DriveNoise::scatter(const PoseTrack& track) const {
  const double position = fit_.model.value[kCapturePosition] + kLeastScatter * kLeastScatter / 2,
               heading = fit_.model.value[kCaptureHeading] + kLeastScatter * kLeastScatter / 2;
  const double dx = track.x.back() - track.x.front(), dy = track.y.back() - track.y.front();
  const double c = std::cos(track.theta.front()), s = std::sin(track.theta.front());
  // An error of the first heading turns the drive about its start.
  const Eigen::Vector3d start(-s * dx + c * dy, -(c * dx + s * dy), -1);
  Eigen::Matrix3d covariance =
      propagated_noise(fit_.model, track) + Eigen::Matrix3d(heading * start * start.transpose());
  covariance.diagonal() += Eigen::Vector3d(2 * position, 2 * position, heading);
  return covariance;
}

Eigen::Matrix3d DriveNoise::repeating(const PoseTrack& track) const {
  return propagated_noise(rest_, track);
}

}  // namespace odobench
