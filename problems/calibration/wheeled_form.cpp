#include "problems/calibration/wheeled_form.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"
#include "base/range.hpp"

namespace odobench {
namespace {

using Eigen::Index;
using Turn = Eigen::Matrix2d;

Turn turn(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Turn r;
  r << c, -s, s, c;
  return r;
}
// d turn(angle) / d angle = quarter() turn(angle)
Turn quarter() {
  Turn r;
  r << 0, -1, 1, 0;
  return r;
}

const Signal& signal_of(const Recording& recording, const std::string& name) {
  const Signal* signal = recording.find(name);
  if (signal == nullptr)
    throw std::invalid_argument(
        fmt::format("recording '{}' has no signal '{}', which the robot needs", recording.id, name));
  return *signal;
}

// Stamps with a reference.
std::vector<std::size_t> reference_stamps(const Recording& recording) {
  if (!recording.reference.sample.empty()) return recording.reference.sample;
  std::vector<std::size_t> all(recording.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  return all;
}

}  // namespace

WheeledForm::WheeledForm(robots::WheeledRobot robot, const std::vector<Recording>& recordings,
                         const CalibrationOptions& options, InstructionSet kernel)
    : robot_(std::move(robot)), options_(options) {
  const auto own = static_cast<Index>(robot_.parameters().size());
  parameter_count_ = own + (options_.mount ? 3 : 0);
  for (const Recording& recording : recordings) {
    drives_.push_back(prepare(recording));
    residual_count_ += drives_.back().residuals;
  }
  prepare_fast_cost(kernel);
}

void WheeledForm::prepare_fast_cost(InstructionSet kernel) {
  if (options_.cost != CostKind::EverySample || options_.mount || !robot_.is_linear() ||
      !LinearStreams::serves(options_.rule, robot_.stream_count()))
    return;
  for (const Drive& drive : drives_)
    if (drive.wrapped) return;
  fast_ = std::make_unique<LinearStreams>(robot_.matrix(robot_.nominal()), options_.rule, kernel);
  for (const Drive& drive : drives_)
    fast_->add(drive.streams, drive.start, drive.reference.rightCols(drive.reference.cols() - 1));
  fast_->finish();
}

WheeledForm::Drive WheeledForm::prepare(const Recording& recording) const {
  Drive drive;
  const auto intervals = static_cast<Index>(recording.size()) - 1;
  drive.seconds.resize(intervals);
  for (Index k = 0; k < intervals; ++k) {
    const auto i = static_cast<std::size_t>(k);
    drive.seconds[k] = static_cast<double>(recording.time_us[i + 1] - recording.time_us[i]) * 1e-6;
  }
  const std::vector<std::string>& names = robot_.signals();
  drive.signals.resize(static_cast<Index>(names.size()), intervals);
  bool speeds = false, increments = false;
  for (Index row = 0; row < drive.signals.rows(); ++row) {
    const Signal& signal = signal_of(recording, names[static_cast<std::size_t>(row)]);
    const bool drives = row < robot_.drive_count();
    if ((signal.kind == SignalKind::Angle) == drives)
      throw std::invalid_argument(
          fmt::format("recording '{}': signal '{}' is {} {}, expected {}", recording.id, signal.name,
                      drives                             ? "an"
                      : signal.kind == SignalKind::Speed ? "a"
                                                         : "an",
                      name_of(signal.kind), drives ? "a speed or an increment" : "an angle"));
    speeds = speeds || signal.kind == SignalKind::Speed;
    increments = increments || signal.kind == SignalKind::Increment;
    const std::size_t shift = increments ? 1 : 0;
    for (Index k = 0; k < intervals; ++k) {
      const double value = signal.values[static_cast<std::size_t>(k) + shift];
      drive.signals(row, k) = signal.kind == SignalKind::Speed ? value * drive.seconds[k] : value;
    }
  }
  if (speeds && increments)
    throw std::invalid_argument(fmt::format(
        "recording '{}' mixes speeds and increments of its wheels, expected one of them", recording.id));
  if (robot_.is_linear()) drive.streams = robot_.streams(drive.signals);
  choose_rows(recording, drive);
  return drive;
}

void WheeledForm::choose_rows(const Recording& recording, Drive& drive) const {
  const Reference& reference = recording.reference;
  const std::vector<std::size_t> stamps = reference_stamps(recording);
  drive.wrapped = !reference.sample.empty();
  const bool at_start = stamps.front() == 0;
  drive.start = Eigen::Vector3d::Zero();
  if (at_start) {
    drive.start[2] = reference.theta[0];
    if (!options_.from_origin) drive.start.head<2>() << reference.x[0], reference.y[0];
  }
  if (stamps.back() == 0)
    throw std::invalid_argument(fmt::format("recording '{}' has no reference after its start", recording.id));

  // Entries of the reference that become rows.
  std::vector<std::size_t> entries;
  const std::size_t first = at_start ? 1 : 0, last = stamps.size() - 1;
  if (options_.cost == CostKind::EverySample) {
    for (std::size_t i = first; i <= last; ++i) entries.push_back(i);
  } else if (options_.cost == CostKind::FinalPose) {
    entries.push_back(last);
  } else if (options_.piece_seconds > 0 || options_.piece_metres > 0) {
    return choose_pieces(recording, stamps, drive);
  } else {
    const Vector nominal = robot_.nominal();
    Vector z = Vector::Zero(parameter_count_);
    z.head(nominal.size()) = nominal;
    const Matrix path = motions(drive, point(z, false));
    double travelled = 0;
    std::size_t k = 0;
    for (std::size_t i = first; i <= last; ++i) {
      for (; k < stamps[i]; ++k) travelled += path.col(static_cast<Index>(k)).head<2>().norm();
      if (travelled < options_.distance && i != last) continue;
      entries.push_back(i);
      travelled = 0;
    }
  }
  drive.reference.resize(3, static_cast<Index>(entries.size()) + 1);
  drive.rows = {0};
  drive.reference.col(0) = drive.start;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    drive.rows.push_back(stamps[entries[i]]);
    drive.reference.col(static_cast<Index>(i) + 1) << reference.x[entries[i]], reference.y[entries[i]],
        reference.theta[entries[i]];
  }
  drive.residuals = residuals_per_row() * static_cast<Index>(entries.size());
}

void WheeledForm::choose_pieces(const Recording& recording, const std::vector<std::size_t>& stamps,
                                Drive& drive) const {
  const Reference& reference = recording.reference;
  const bool by_time = options_.piece_seconds > 0;
  const double piece = by_time ? options_.piece_seconds : options_.piece_metres;
  std::vector<std::size_t> entries;
  double travelled = 0, next = 0;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (by_time)
      travelled = static_cast<double>(recording.time_us[stamps[i]] - recording.time_us[0]) * 1e-6;
    else if (i > 0)
      travelled += std::hypot(reference.x[i] - reference.x[i - 1], reference.y[i] - reference.y[i - 1]);
    if (travelled < next) continue;
    entries.push_back(i);
    next = (std::floor(travelled / piece) + 1) * piece;
  }
  drive.rows.clear();
  drive.reference.resize(3, static_cast<Index>(entries.size()));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    drive.rows.push_back(stamps[entries[i]]);
    drive.reference.col(static_cast<Index>(i)) << reference.x[entries[i]], reference.y[entries[i]],
        reference.theta[entries[i]];
  }
  drive.residuals = residuals_per_row() * (static_cast<Index>(entries.size()) - 1);
}

WheeledForm::Point WheeledForm::point(const ConstVectorRef& z, bool derivatives) const {
  Point at;
  at.robot = z.head(static_cast<Index>(robot_.parameters().size()));
  // Sums of squares of what comes of larger numbers are not finite.
  at.usable = z.allFinite() && z.cwiseAbs().maxCoeff() <= kLargestNumber;
  if (!at.usable) return at;
  if (options_.mount) at.mount = z.tail<3>();
  if (robot_.is_linear()) {
    if (derivatives)
      robot_.matrix_and_derivatives(at.robot, at.matrix, at.derivatives);
    else
      at.matrix = robot_.matrix(at.robot);
  }
  return at;
}

Matrix WheeledForm::motions(const Drive& drive, const Point& at) const {
  if (robot_.is_linear()) return at.matrix * drive.streams;
  Matrix motions(3, drive.signals.cols());
  robot_.twists(drive.signals, at.robot, motions);
  return motions;
}

Matrix WheeledForm::poses(const Drive& drive, const Point& at) const {
  Matrix poses(3, drive.seconds.size() + 1);
  robots::integrate(options_.rule, motions(drive, at), Eigen::Vector3d::Zero(), poses, drive.seconds);
  return poses;
}

void WheeledForm::residuals(const Drive& drive, const Point& at, VectorRef r, MatrixRef* j) const {
  const Index intervals = drive.seconds.size(), own = at.robot.size();
  if (!at.usable) {
    r.setConstant(kNotANumber);
    if (j != nullptr) j->setConstant(kNotANumber);
    return;
  }
  Matrix positions, by;
  if (j == nullptr) {
    positions = poses(drive, at);
  } else {
    Matrix moved(3, intervals), moved_by(3 * intervals, own);
    if (robot_.is_linear()) {
      moved = at.matrix * drive.streams;
      for (Index p = 0; p < own; ++p)
        Eigen::Map<Matrix>(moved_by.col(p).data(), 3, intervals).noalias() =
            at.derivatives[static_cast<std::size_t>(p)] * drive.streams;
    } else {
      robot_.twists_and_jacobian(drive.signals, at.robot, moved, moved_by);
    }
    positions.resize(3, intervals + 1);
    by.resize(3 * (intervals + 1), own);
    robots::integrate(options_.rule, moved, moved_by, Eigen::Vector3d::Zero(), positions, by, drive.seconds);
  }
  if (options_.cost == CostKind::Segments)
    piece_residuals(drive, at, positions, by, r, j);
  else
    absolute_residuals(drive, at, positions, by, r, j);
}

void WheeledForm::absolute_residuals(const Drive& drive, const Point& at, const Matrix& poses,
                                     const Matrix& by, VectorRef r, MatrixRef* j) const {
  const double position = std::sqrt(options_.position_weight), heading = std::sqrt(options_.heading_weight);
  const Index own = at.robot.size(), per_row = residuals_per_row();
  const Eigen::Vector2d place = at.mount.head<2>();
  const Turn frame = turn(drive.start[2] - at.mount[2]);
  for (std::size_t i = 1; i < drive.rows.size(); ++i) {
    const auto k = static_cast<Index>(drive.rows[i]), entry = static_cast<Index>(i);
    const double alpha = poses(2, k);
    const Turn turned = turn(alpha);
    const Eigen::Vector2d relative = poses.col(k).head<2>() + turned * place - place;
    const Index row = per_row * (entry - 1);
    r.segment<2>(row) =
        position * (drive.start.head<2>() + frame * relative - drive.reference.col(entry).head<2>());
    if (per_row == 3) {
      const double error = drive.start[2] + alpha - drive.reference(2, entry);
      r[row + 2] = heading * (drive.wrapped ? wrapped_angle(error) : error);
    }
    if (j == nullptr) continue;
    const auto alpha_by = by.row(3 * k + 2);
    j->block(row, 0, 2, own) =
        position * frame * (by.middleRows(3 * k, 2) + quarter() * turned * place * alpha_by);
    if (per_row == 3) j->block(row + 2, 0, 1, own) = heading * alpha_by;
    if (!options_.mount) continue;
    j->block<2, 2>(row, own) = position * frame * (turned - Turn::Identity());
    j->block<2, 1>(row, own + 2) = -position * quarter() * frame * relative;
    if (per_row == 3) j->block<1, 3>(row + 2, own).setZero();
  }
}

void WheeledForm::piece_residuals(const Drive& drive, const Point& at, const Matrix& poses, const Matrix& by,
                                  VectorRef r, MatrixRef* j) const {
  const double position = std::sqrt(options_.position_weight), heading = std::sqrt(options_.heading_weight);
  const Index own = at.robot.size();
  const Eigen::Vector2d place = at.mount.head<2>();
  for (std::size_t i = 1; i < drive.rows.size(); ++i) {
    const auto from = static_cast<Index>(drive.rows[i - 1]), to = static_cast<Index>(drive.rows[i]),
               entry = static_cast<Index>(i);
    const double a = poses(2, from), b = poses(2, to);
    const Turn turned_a = turn(a), turned_b = turn(b), frame = turn(-at.mount[2] - a);
    const Eigen::Vector2d moved =
        poses.col(to).head<2>() - poses.col(from).head<2>() + (turned_b - turned_a) * place;
    const auto measured_from = drive.reference.col(entry - 1), measured_to = drive.reference.col(entry);
    const Eigen::Vector2d measured =
        turn(-measured_from[2]) * (measured_to.head<2>() - measured_from.head<2>());
    const Index row = 3 * (entry - 1);
    r.segment<2>(row) = position * (frame * moved - measured);
    const double error = b - a - (measured_to[2] - measured_from[2]);
    r[row + 2] = heading * (drive.wrapped ? wrapped_angle(error) : error);
    if (j == nullptr) continue;
    const auto a_by = by.row(3 * from + 2), b_by = by.row(3 * to + 2);
    j->block(row, 0, 2, own) =
        position * (frame * (by.middleRows(3 * to, 2) - by.middleRows(3 * from, 2) +
                             quarter() * turned_b * place * b_by - quarter() * turned_a * place * a_by) -
                    quarter() * frame * moved * a_by);
    j->block(row + 2, 0, 1, own) = heading * (b_by - a_by);
    if (!options_.mount) continue;
    j->block<2, 2>(row, own) = position * frame * (turned_b - turned_a);
    j->block<2, 1>(row, own + 2) = -position * quarter() * frame * moved;
    j->block<1, 3>(row + 2, own).setZero();
  }
}

double WheeledForm::cost(const ConstVectorRef& z) const {
  const Point at = point(z, false);
  if (fast_ && at.usable) {
    const double cost = fast_->cost(at.matrix, options_.position_weight, options_.heading_weight);
    if (!std::isnan(cost)) return cost;
  }
  double sum = 0;
  Vector r;
  for (const Drive& drive : drives_) {
    r.resize(drive.residuals);
    residuals(drive, at, r, nullptr);
    sum += r.squaredNorm();
  }
  return sum;
}

void WheeledForm::residuals(const ConstVectorRef& z, VectorRef r) const {
  const Point at = point(z, false);
  Index row = 0;
  for (const Drive& drive : drives_) {
    residuals(drive, at, r.segment(row, drive.residuals), nullptr);
    row += drive.residuals;
  }
}

void WheeledForm::residuals_and_jacobian(const ConstVectorRef& z, VectorRef r, MatrixRef j) const {
  const Point at = point(z, true);
  Index row = 0;
  for (const Drive& drive : drives_) {
    MatrixRef block = j.middleRows(row, drive.residuals);
    residuals(drive, at, r.segment(row, drive.residuals), &block);
    row += drive.residuals;
  }
}

void WheeledForm::normal_equations(const ConstVectorRef& z, NormalEquations& out) const {
  const Point at = point(z, true);
  if (fast_ && at.usable &&
      fast_->normal_equations(at.matrix, at.derivatives, options_.position_weight, options_.heading_weight,
                              out))
    return;
  const Index n = parameter_count_;
  out.cost = 0;
  out.jtr = Vector::Zero(n);
  out.jtj = Matrix::Zero(n, n);
  Vector r;
  Matrix j;
  for (const Drive& drive : drives_) {
    r.resize(drive.residuals);
    j.resize(drive.residuals, n);
    MatrixRef block = j;
    residuals(drive, at, r, &block);
    out.cost += r.squaredNorm();
    out.jtr.noalias() += j.transpose() * r;
    out.jtj.selfadjointView<Eigen::Lower>().rankUpdate(j.transpose());
  }
  out.jtj.triangularView<Eigen::StrictlyUpper>() = out.jtj.transpose();
}

Matrix WheeledForm::track(std::size_t recording, const ConstVectorRef& z) const {
  const Drive& drive = drives_.at(recording);
  const Point at = point(z, false);
  Matrix track = poses(drive, at);
  const Eigen::Vector2d place = at.mount.head<2>();
  const Turn frame = turn(drive.start[2] - at.mount[2]);
  for (Index k = 0; k < track.cols(); ++k) {
    const Eigen::Vector2d relative = track.col(k).head<2>() + turn(track(2, k)) * place - place;
    track.col(k).head<2>() = drive.start.head<2>() + frame * relative;
    track(2, k) += drive.start[2];
  }
  return track;
}

Vector WheeledForm::slip(std::size_t recording, const ConstVectorRef& z) const {
  const Drive& drive = drives_.at(recording);
  return robot_.residual_norms(drive.signals, point(z, false).robot);
}

}  // namespace odobench
