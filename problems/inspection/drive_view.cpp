#include "problems/inspection/drive_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/range.hpp"

namespace odobench::inspection {
namespace {

WheelTable least_squares(WheelTable table) {
  table.rule = TwistRule::LeastSquares;
  return table;
}

std::string spoken(std::string signal) {
  std::replace(signal.begin(), signal.end(), '.', ' ');
  return signal;
}

const Signal& needed_signal(const Recording& recording, const std::string& name) {
  const Signal* signal = recording.find(name);
  if (signal == nullptr)
    throw std::invalid_argument(fmt::format("recording '{}' has no signal '{}'", recording.id, name));
  return *signal;
}

double tangent_of(const Wheel& w) {
  return std::tan(w.roller);
}

}  // namespace

RobotView::RobotView(const Robot& own)
    : twist(least_squares(own.table)), mean(own.table.rule == TwistRule::Mean), robot(&own) {
  from_origin = own.kinematics == "4wis4wid";
  const auto column = [&](const std::string& name) {
    return std::find(twist.signals().begin(), twist.signals().end(), name) - twist.signals().begin();
  };
  for (const Wheel& w : own.table.wheels) {
    WheelView view{w, {}, -1, "", ""};
    for (const DriveSignal& d : w.drive) view.drives.emplace_back(column(d.name), d.weight);
    if (!w.drive.empty()) view.label = spoken(w.drive.front().name);
    if (!w.steering.empty()) {
      view.steering = column(w.steering) - twist.drive_count();
      view.steering_label = spoken(w.steering);
      if (view.label.empty()) view.label = view.steering_label;
    }
    wheels.push_back(view);
  }
  for (const BoundParameter& p : own.table.parameters)
    for (const Binding& b : p.bindings)
      field_of(wheels[b.wheel].nominal, b.field) += b.factor * p.parameter.nominal;
  for (const WheelView& w : wheels)
    distance += std::hypot(w.nominal.x, w.nominal.y) / static_cast<double>(wheels.size());
}

bool RobotView::free(WheelField field) const {
  for (const BoundParameter& p : robot->table.parameters)
    for (const Binding& b : p.bindings)
      if (b.field == field && p.parameter.lower < p.parameter.upper) return true;
  return false;
}

Drive drive_view(const RobotView& robot, const Recording& recording) {
  Drive d;
  d.recording = &recording;
  const auto n = static_cast<Index>(recording.size());
  if (n < 2) return d;
  d.t.resize(n);
  for (Index k = 0; k < n; ++k)
    d.t[k] =
        1e-6 * static_cast<double>(recording.time_us[static_cast<std::size_t>(k)] - recording.time_us[0]);
  update_stamps(d);
  const std::vector<std::string>& names = robot.twist.signals();
  const Index drives = robot.twist.drive_count(), steerings = static_cast<Index>(names.size()) - drives;
  d.motion.resize(n - 1, drives);
  d.angle.resize(n, steerings);
  for (Index i = 0; i < drives; ++i) {
    const Signal& signal = needed_signal(recording, names[static_cast<std::size_t>(i)]);
    const Eigen::Map<const Vector> values(signal.values.data(), n);
    d.increments = signal.kind == SignalKind::Increment;
    if (d.increments)
      d.motion.col(i) = values.tail(n - 1);
    else
      d.motion.col(i) = values.head(n - 1).array() * (d.t.tail(n - 1) - d.t.head(n - 1)).array();
  }
  for (Index i = 0; i < steerings; ++i)
    d.angle.col(i) = Eigen::Map<const Vector>(
        needed_signal(recording, names[static_cast<std::size_t>(drives + i)]).values.data(), n);
  d.dense = recording.reference.sample.empty() && recording.reference.x.size() == recording.size() && n >= 5;
  d.bad.assign(recording.size(), 0);
  if (!d.dense) return d;
  d.x = Eigen::Map<const Vector>(recording.reference.x.data(), n);
  d.y = Eigen::Map<const Vector>(recording.reference.y.data(), n);
  d.theta = Eigen::Map<const Vector>(recording.reference.theta.data(), n);
  return d;
}

void update_stamps(Drive& d) {
  const Index n = d.samples();
  std::vector<double> steps;
  for (Index k = 0; k + 1 < n; ++k) steps.push_back(d.seconds(k));
  d.step = median(steps);
  const double wanted = d.step > 0 ? 0.25 / d.step : 0;
  const Index most = std::max<Index>(3, n / 20);
  d.line = LocalLine(
      d.t, std::max<Index>(
               2, wanted < static_cast<double>(most) ? static_cast<Index>(std::lround(wanted)) : most));
}

void update_reference(Drive& d) {
  const Vector vx = d.line.slope(d.x), vy = d.line.slope(d.y);
  d.w = d.line.slope(d.theta);
  const Eigen::ArrayXd c = d.theta.array().cos(), s = d.theta.array().sin();
  d.fx = c * vx.array() + s * vy.array();
  d.fy = c * vy.array() - s * vx.array();
}

void update_wheels(const RobotView& robot, Drive& d) {
  const Index n = d.samples(), count = static_cast<Index>(robot.wheels.size());
  d.speed.setZero(n, count);
  d.c.resize(n, count);
  d.s.resize(n, count);
  Vector sum(n);
  for (Index i = 0; i < count; ++i) {
    const WheelView& w = robot.wheels[static_cast<std::size_t>(i)];
    if (w.driven()) {
      sum[0] = 0;
      for (Index k = 0; k + 1 < n; ++k) {
        double step = 0;
        for (const auto& [column, weight] : w.drives) step += weight * d.motion(k, column);
        sum[k + 1] = sum[k] + step;
      }
      d.speed.col(i) = d.line.slope(sum);
    }
    const double turn = w.nominal.roller, mount = w.nominal.mount + turn;
    if (w.steering < 0) {
      d.c.col(i).setConstant(std::cos(mount));
      d.s.col(i).setConstant(std::sin(mount));
      continue;
    }
    const Eigen::ArrayXd phi = mount + w.nominal.zero + w.nominal.gain * d.angle.col(w.steering).array();
    d.c.col(i) = phi.cos();
    d.s.col(i) = phi.sin();
  }
}

void update_twist(const RobotView& robot, Drive& d) {
  const Index n = d.samples(), drives = d.motion.cols();
  Matrix signals(drives + d.angle.cols(), n - 1);
  signals.topRows(drives) = d.motion.transpose();
  if (d.angle.cols() > 0)  // rows of a matrix without columns have no address
    signals.bottomRows(d.angle.cols()) = d.angle.middleRows(d.increments ? 1 : 0, n - 1).transpose();
  Matrix steps(3, n - 1);
  if (robot.twist.is_linear())
    steps.noalias() = robot.twist.matrix(robot.twist.nominal()) * robot.twist.streams(signals);
  else
    robot.twist.twists(signals, robot.twist.nominal(), steps);
  d.twist.resize(n, 3);
  Vector sum(n);
  for (Index row = 0; row < 3; ++row) {
    sum[0] = 0;
    for (Index k = 0; k + 1 < n; ++k) sum[k + 1] = sum[k] + steps(row, k);
    d.twist.col(row) = d.line.slope(sum);
  }
}

double wheel_path(const RobotView& robot, const Drive& d, Index interval) {
  double path = 0, driven = 0;
  for (const WheelView& w : robot.wheels) {
    if (!w.driven()) continue;
    double step = 0;
    for (const auto& [column, weight] : w.drives) step += weight * d.motion(interval, column);
    path += std::abs(step) * w.nominal.radius;
    ++driven;
  }
  return driven > 0 ? path / driven : 0;
}

WheelVelocity velocity_of(const RobotView& robot, const Drive& d, std::size_t wheel) {
  const Wheel& w = robot.wheels[wheel].nominal;
  const auto i = static_cast<Index>(wheel);
  WheelVelocity u;
  u.x = d.fx - w.y * d.w;
  u.y = d.fy + w.x * d.w;
  if (w.trail != 0 || w.offset != 0) {
    u.x.array() -= d.w.array() * (w.trail * d.s.col(i).array() + w.offset * d.c.col(i).array());
    u.y.array() += d.w.array() * (w.trail * d.c.col(i).array() - w.offset * d.s.col(i).array());
  }
  u.along = d.c.col(i).array() * u.x.array() + d.s.col(i).array() * u.y.array();
  return u;
}

Vector rolling_of(const RobotView& robot, const Drive& d, std::size_t wheel) {
  const Wheel& w = robot.wheels[wheel].nominal;
  return w.radius / std::hypot(1.0, tangent_of(w)) * d.speed.col(static_cast<Index>(wheel));
}

Sums::Sums(std::size_t wheels) : both(Vector::Zero(static_cast<Index>(wheels))), own(both), all(both) {}

Sums& Sums::operator+=(const Sums& other) {
  both += other.both;
  own += other.own;
  all += other.all;
  return *this;
}

void update_sums(const RobotView& robot, Drive& d) {
  const Index n = d.samples();
  Sums sums(robot.wheels.size());
  Matrix along(n, static_cast<Index>(robot.wheels.size())), squares = along;
  d.mean_u.setZero(n);
  double stating = 0;
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    if (!robot.wheels[i].states()) continue;
    const WheelVelocity u = velocity_of(robot, d, i);
    const auto column = static_cast<Index>(i);
    const bool slides = robot.wheels[i].nominal.slides;
    along.col(column) = u.along;
    squares.col(column) =
        slides ? u.along.array().square().eval() : (u.x.array().square() + u.y.array().square()).eval();
    d.mean_u.array() += squares.col(column).array().sqrt();
    ++stating;
  }
  d.mean_u /= std::max(1.0, stating);
  std::vector<double> sorted(d.mean_u.data(), d.mean_u.data() + n);
  d.level = percentile(sorted, 0.95);
  d.used.assign(static_cast<std::size_t>(n), 0);
  Vector mask = Vector::Zero(n);
  for (Index k = d.line.half(); k < n - d.line.half(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    d.used[at] = d.mean_u[k] > 0.3 * d.level && d.bad[at] == 0 ? 1 : 0;
    mask[k] = d.used[at];
  }
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    if (!robot.wheels[i].states()) continue;
    const auto column = static_cast<Index>(i);
    const Vector one = mask.cwiseProduct(along.col(column));
    sums.all[column] = mask.dot(squares.col(column));
    if (robot.wheels[i].driven()) {
      const Vector m = rolling_of(robot, d, i);
      sums.both[column] = one.dot(m);
      sums.own[column] = mask.cwiseProduct(m).dot(m);
    } else {
      sums.both[column] = sums.own[column] = one.squaredNorm();
    }
  }
  d.sums = std::move(sums);
}

SlopeFit slope_fit(const RobotView& robot, const Sums& sums) {
  SlopeFit fit;
  fit.slope = Vector::Constant(sums.both.size(), kNotANumber);
  double left = 0, all = 0, mean = 0, squares = 0, count = 0, negative = 0;
  for (Index i = 0; i < sums.both.size(); ++i) {
    all += sums.all[i];
    left += sums.all[i];
    if (!(sums.own[i] > 0)) continue;
    left -= sums.both[i] * sums.both[i] / sums.own[i];
    if (!robot.wheels[static_cast<std::size_t>(i)].driven()) continue;
    const double k = fit.slope[i] = sums.both[i] / sums.own[i];
    mean += std::abs(k);
    squares += k * k;
    ++count;
    if (k < 0) ++negative;
  }
  fit.misfit = all > 0 ? left / all : 0;
  mean /= std::max(1.0, count);
  const double spread = std::sqrt(std::max(0.0, squares / std::max(1.0, count) - mean * mean));
  fit.score = fit.misfit + (mean > 0 ? 0.05 * spread / mean : 0) + 0.02 * negative;
  return fit;
}

double misfit_with(const Sums& sums, const Vector& slope) {
  double left = 0, all = 0;
  for (Index i = 0; i < sums.both.size(); ++i) {
    const double k = std::isfinite(slope[i])                          ? slope[i]
                     : sums.own[i] > 0 && sums.both[i] == sums.own[i] ? 1
                                                                      : 0;
    all += sums.all[i];
    left += sums.all[i] - 2 * k * sums.both[i] + k * k * sums.own[i];
  }
  return all > 0 ? left / all : 0;
}

}  // namespace odobench::inspection
