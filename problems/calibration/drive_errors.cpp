#include "problems/calibration/drive_errors.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"
#include "problems/calibration/robust_form.hpp"

namespace odobench {
namespace {

Eigen::Vector3d track_pose(const PoseTrack& track, std::size_t k) {
  return {track.x[k], track.y[k], track.theta[k]};
}

// The reference at a stamp; a drive without one at its start begins at the origin.
Eigen::Vector3d reference_at(const Reference& reference, std::size_t stamp) {
  std::size_t entry = stamp;
  if (!reference.sample.empty()) {
    const auto found = std::lower_bound(reference.sample.begin(), reference.sample.end(), stamp);
    if (found == reference.sample.end() || *found != stamp) return Eigen::Vector3d::Zero();
    entry = static_cast<std::size_t>(found - reference.sample.begin());
  }
  return {reference.x[entry], reference.y[entry], reference.theta[entry]};
}

Eigen::Vector3d seen_from(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const double c = std::cos(from[2]), s = std::sin(from[2]), dx = to[0] - from[0], dy = to[1] - from[1];
  return {c * dx + s * dy, c * dy - s * dx, to[2] - from[2]};
}

}  // namespace

DriveErrors drive_errors(const Recording& recording, const PoseTrack& track) {
  DriveErrors errors;
  const Reference& reference = recording.reference;
  const bool everywhere = reference.sample.empty();
  for (std::size_t entry = 0; entry < reference.x.size(); ++entry) {
    const std::size_t k = everywhere ? entry : reference.sample[entry];
    const double dx = reference.x[entry] - track.x[k], dy = reference.y[entry] - track.y[k];
    const double turned = reference.theta[entry] - track.theta[k];
    errors.end_position = std::hypot(dx, dy);
    errors.end_heading = std::abs(everywhere ? turned : wrapped_angle(turned));
    errors.max_position = std::max(errors.max_position, errors.end_position);
    errors.max_heading = std::max(errors.max_heading, errors.end_heading);
    errors.end = {dx, dy, wrapped_angle(turned)};
    if (k == 0) continue;
    errors.rms_position += dx * dx + dy * dy;
    errors.rms_heading += errors.end_heading * errors.end_heading;
    ++errors.samples;
  }
  const auto samples = static_cast<double>(std::max<std::size_t>(errors.samples, 1));
  errors.rms_position = std::sqrt(errors.rms_position / samples);
  errors.rms_heading = std::sqrt(errors.rms_heading / samples);
  const bool at_start = everywhere || (!reference.sample.empty() && reference.sample[0] == 0);
  const double start = at_start && !reference.theta.empty() ? reference.theta[0] : track.theta[0];
  const double c = std::cos(start), s = std::sin(start), dx = errors.end[0], dy = errors.end[1];
  errors.end[0] = c * dx + s * dy;
  errors.end[1] = c * dy - s * dx;
  return errors;
}

int sense_of(const PoseTrack& track) {
  const double turned = track.theta.back() - track.theta.front();
  return turned > kPi / 2 ? 1 : turned < -kPi / 2 ? -1 : 0;
}

double cost_of_tracks(const CalibrationProblem& problem, const std::vector<PoseTrack>& tracks) {
  if (problem.structured()) throw std::invalid_argument("cost_of_tracks: the problem has no rows");
  const CalibrationOptions& options = problem.options();
  const double heading_weight = options.cost == CostKind::Optiodom ? 0 : options.heading_weight;
  const Eigen::Index row = options.cost == CostKind::Optiodom ? 2 : 3;
  double cost = 0, robust = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Recording& recording = problem.recordings()[i];
    const std::vector<std::size_t>& rows = problem.rows(i);
    const bool wrapped = !recording.reference.sample.empty();
    Vector weighted(row * static_cast<Eigen::Index>(std::max<std::size_t>(rows.size(), 1) - 1));
    for (std::size_t r = 1; r < rows.size(); ++r) {
      const Eigen::Vector3d measured = reference_at(recording.reference, rows[r]);
      const Eigen::Vector3d reckoned = track_pose(tracks[i], rows[r]);
      Eigen::Vector3d e = reckoned - measured;
      if (options.cost == CostKind::Segments)
        e = seen_from(track_pose(tracks[i], rows[r - 1]), reckoned) -
            seen_from(reference_at(recording.reference, rows[r - 1]), measured);
      if (wrapped) e[2] = wrapped_angle(e[2]);
      cost += options.position_weight * e.head<2>().squaredNorm() + heading_weight * e[2] * e[2];
      if (!options.loss.robust()) continue;
      e.head<2>() *= std::sqrt(options.position_weight);
      e[2] *= std::sqrt(heading_weight);
      weighted.segment(row * static_cast<Eigen::Index>(r - 1), row) = e.head(row);
    }
    if (options.loss.robust()) robust += robust_cost(options.loss, weighted, row);
  }
  return options.loss.robust() ? robust : cost;
}

}  // namespace odobench
