#include "problems/robots/wheeled_robot.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "base/error.hpp"
#include "problems/robots/wheeled_robot_workspace.hpp"

namespace odobench::robots {
namespace {

constexpr double kLeastSingularValue = 1e-6;  // of the largest

[[noreturn]] void refuse_shape(const char* what, Eigen::Index rows, Eigen::Index columns,
                               Eigen::Index expected_rows, Eigen::Index expected_columns) {
  throw std::invalid_argument(fmt::format("robot: {} are {} x {}, expected {} x {}", what, rows, columns,
                                          expected_rows, expected_columns));
}

void check_shape(const char* what, const ConstMatrixRef& m, Eigen::Index rows, Eigen::Index columns) {
  if (m.rows() != rows || m.cols() != columns) refuse_shape(what, m.rows(), m.cols(), rows, columns);
}

// Adds a row and its right side to A'A (lower triangle) and A'b.
void add_row(const Eigen::Vector3d& a, double b, Eigen::Matrix3d& n, Eigen::Vector3d& h) {
  n(0, 0) += a[0] * a[0];
  n(1, 0) += a[1] * a[0];
  n(2, 0) += a[2] * a[0];
  n(1, 1) += a[1] * a[1];
  n(2, 1) += a[2] * a[1];
  n(2, 2) += a[2] * a[2];
  h += b * a;
}

}  // namespace

WheeledRobot::WheeledRobot(WheelTable table) : table_(std::move(table)) {
  check(table_);
  for (const BoundParameter& bound : table_.parameters) parameters_.push_back(bound.parameter);
  plan_signals();
  plan_fields();
  plan_streams();
  if (table_.rule != TwistRule::LeastSquares || form_ != LinearForm::Wheels) return;
  try {  // the rows are the same for all signals
    Matrix t(3, 1);
    twists(Matrix::Zero(static_cast<Eigen::Index>(signals_.size()), 1), nominal(), t);
  } catch (const DataError& error) {
    throw std::invalid_argument(fmt::format("robot: nominal values: {}", error.what()));
  }
}

void WheeledRobot::plan_signals() {
  const auto row_of_signal = [this](const std::string& name) {
    const auto found = std::find(signals_.begin(), signals_.end(), name);
    if (found == signals_.end()) signals_.push_back(name);
    return static_cast<Eigen::Index>(std::find(signals_.begin(), signals_.end(), name) - signals_.begin());
  };
  for (const Wheel& wheel : table_.wheels) {
    Plan plan;
    for (const DriveSignal& signal : wheel.drive)
      plan.drives.emplace_back(row_of_signal(signal.name), signal.weight);
    plan.driven = !wheel.drive.empty();
    plan.slides = wheel.slides;
    plans_.push_back(std::move(plan));
  }
  drive_count_ = static_cast<Eigen::Index>(signals_.size());
  for (std::size_t i = 0; i < plans_.size(); ++i)
    if (!table_.wheels[i].steering.empty()) plans_[i].steering = row_of_signal(table_.wheels[i].steering);
}

void WheeledRobot::plan_fields() {
  std::map<std::pair<std::size_t, WheelField>, std::vector<Term>> fields;
  for (std::size_t p = 0; p < table_.parameters.size(); ++p)
    for (const Binding& b : table_.parameters[p].bindings)
      fields[{b.wheel, b.field}].push_back({static_cast<Eigen::Index>(p), b.factor});
  for (auto& [key, terms] : fields) fields_.push_back({key.first, key.second, std::move(terms)});
}

Vector WheeledRobot::nominal() const {
  Vector z(static_cast<Eigen::Index>(parameters_.size()));
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    z[static_cast<Eigen::Index>(i)] = parameters_[i].nominal;
  return z;
}

std::vector<WheelNumbers> WheeledRobot::numbers(const ConstVectorRef& z) const {
  if (z.size() != static_cast<Eigen::Index>(parameters_.size()))
    throw std::invalid_argument(
        fmt::format("robot: {} parameters, expected {}", z.size(), parameters_.size()));
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    if (!std::isfinite(z[static_cast<Eigen::Index>(i)]))
      throw std::invalid_argument(fmt::format("robot: parameter '{}' is not finite", parameters_[i].name));
  std::vector<Wheel> wheels = table_.wheels;
  for (const BoundField& f : fields_)
    for (const Term& term : f.terms) field_of(wheels[f.wheel], f.field) += term.factor * z[term.parameter];
  std::vector<WheelNumbers> result;
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const Wheel& w = wheels[i];
    if (std::cos(w.roller) < 1e-9)
      throw std::invalid_argument(fmt::format(
          "robot: wheel {}: roller angle {} rad, expected between -pi/2 and pi/2", i + 1, w.roller));
    const bool steered = plans_[i].steering >= 0;
    const double heading = steered ? w.mount + w.zero : w.mount;
    result.push_back({w.x, w.y, w.mount, heading, std::cos(heading), std::sin(heading), w.radius,
                      std::tan(w.roller), w.offset, w.trail, w.gain, steered});
  }
  return result;
}

void WheeledRobot::check_signals(const ConstMatrixRef& signals, const Matrix* rates) const {
  const auto count = static_cast<Eigen::Index>(signals_.size());
  check_shape("signals", signals, count, signals.cols());
  if (!signals.allFinite()) {
    for (Eigen::Index k = 0; k < signals.cols(); ++k)
      for (Eigen::Index i = 0; i < count; ++i)
        if (!std::isfinite(signals(i, k)))
          throw std::invalid_argument(fmt::format("robot: signal '{}' is not finite at sample {}",
                                                  signals_[static_cast<std::size_t>(i)], k));
  }
  if (!rates) return;
  check_shape("steering rates", *rates, count - drive_count_, signals.cols());
  if (!rates->allFinite()) throw std::invalid_argument("robot: a steering rate is not finite");
  if (table_.rule == TwistRule::Mean)
    throw std::invalid_argument("robot: the published mean has no steering rates; use least_squares");
}

WheeledRobot::Workspace WheeledRobot::start(const ConstMatrixRef& signals, const ConstVectorRef& z,
                                            const Matrix* rates) const {
  Workspace w;
  w.wheels = numbers(z);
  check_signals(signals, rates);
  w.readings.resize(w.wheels.size());
  w.contacts.resize(w.wheels.size());
  return w;
}

void WheeledRobot::read(Workspace& w, const ConstMatrixRef& signals, const Matrix* rates,
                        Eigen::Index k) const {
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    const Plan& plan = plans_[i];
    WheelReading& r = w.readings[i];
    r.drive = 0;
    for (const auto& [row, weight] : plan.drives) r.drive += weight * signals(row, k);
    if (plan.steering >= 0) {
      r.steering = signals(plan.steering, k);
      if (rates) r.rate = (*rates)(plan.steering - drive_count_, k);
    }
    w.contacts[i] = contact(w.wheels[i], r.steering);
  }
}

Eigen::Vector3d WheeledRobot::solve(Workspace& w, Eigen::Index k) const {
  if (table_.rule == TwistRule::Mean) return mean(w);
  Eigen::Matrix3d n = Eigen::Matrix3d::Zero();
  Eigen::Vector3d h = Eigen::Vector3d::Zero();
  double distance = 0;  // squared, of the farthest contact
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    const Contact& c = w.contacts[i];
    if (plans_[i].driven) add_row(c.drive_row(), drive_right_side(w.wheels[i], w.readings[i]), n, h);
    if (!plans_[i].slides) add_row(c.side_row(), side_right_side(w.wheels[i], w.readings[i]), n, h);
    if (plans_[i].driven || !plans_[i].slides) distance = std::max(distance, c.px * c.px + c.py * c.py);
  }
  w.normal = Cholesky3(n);
  // Of a symmetric 3 x 3 matrix the least eigenvalue is at least 4 det / trace^2: with room to spare, or
  // looked at.
  const double trace = n(0, 0) + n(1, 1) + n(2, 2) / distance;
  const double safe = 100 * kLeastSingularValue * kLeastSingularValue;
  if (!(w.normal.positive() && 4 * w.normal.determinant() / distance > safe * trace * trace * trace))
    refuse_rank(w, k);
  return w.normal.solve(h);
}

void WheeledRobot::refuse_rank(const Workspace& w, Eigen::Index k) const {
  const WheelRows rows = rows_of(w);
  double distance = 0;
  for (std::size_t i = 0; i < plans_.size(); ++i)
    if (plans_[i].driven || !plans_[i].slides)
      distance = std::max(distance, std::hypot(w.contacts[i].px, w.contacts[i].py));
  Matrix a = rows.a;
  if (distance > 0) a.col(2) /= distance;
  double ratio = 0;
  if (a.allFinite()) {
    const Vector values = Eigen::JacobiSVD<Matrix>(a).singularValues();
    if (values.size() == 3 && values[0] > 0) ratio = values[2] / values[0];
  }
  if (ratio >= kLeastSingularValue && w.normal.positive()) return;
  throw DataError(
      fmt::format("sample {}: the wheels do not tell the twist: least singular value {:.1e} of the largest, "
                  "expected {:.0e} or more, of the rows {}",
                  k, ratio, kLeastSingularValue, fmt::join(rows.names, ", ")));
}

Eigen::Vector3d WheeledRobot::mean(const Workspace& w) const {
  const double share = 1 / static_cast<double>(plans_.size());
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    const Contact& c = w.contacts[i];
    const double v = share * w.wheels[i].radius * w.readings[i].drive;
    const double squared = c.px * c.px + c.py * c.py;
    if (!(squared > 0))
      throw DataError(fmt::format("wheel {} stands at the origin, where the mean has no rotation", i + 1));
    t += v * Eigen::Vector3d(c.ex, c.ey, (c.px * c.ey - c.py * c.ex) / squared);
  }
  return t;
}

void WheeledRobot::twists(const ConstMatrixRef& signals, const ConstVectorRef& z, MatrixRef twists,
                          const Matrix* rates) const {
  check_shape("twists", twists, 3, signals.cols());
  Workspace w = start(signals, z, rates);
  for (Eigen::Index k = 0; k < signals.cols(); ++k) {
    read(w, signals, rates, k);
    twists.col(k) = solve(w, k);
  }
}

void WheeledRobot::twists_and_jacobian(const ConstMatrixRef& signals, const ConstVectorRef& z,
                                       MatrixRef twists, MatrixRef jacobian, const Matrix* rates) const {
  check_shape("twists", twists, 3, signals.cols());
  check_shape("derivatives", jacobian, 3 * signals.cols(), static_cast<Eigen::Index>(parameters_.size()));
  Workspace w = start(signals, z, rates);
  jacobian.setZero();
  for (Eigen::Index k = 0; k < signals.cols(); ++k) {
    read(w, signals, rates, k);
    const Eigen::Vector3d t = solve(w, k);
    twists.col(k) = t;
    for (const BoundField& field : fields_) {
      const Eigen::Vector3d d =
          table_.rule == TwistRule::Mean ? mean_derivative(w, field) : derivative(w, t, field);
      for (const Term& term : field.terms) jacobian.block<3, 1>(3 * k, term.parameter) += term.factor * d;
    }
  }
}

Eigen::Vector3d WheeledRobot::derivative(const Workspace& w, const Eigen::Vector3d& t,
                                         const BoundField& field) const {
  const std::size_t i = field.wheel;
  const Contact& c = w.contacts[i];
  const RowDerivatives d = row_derivatives(w.wheels[i], c, w.readings[i], field.field);
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  const auto add = [&](const Eigen::Vector3d& row, double right, const Eigen::Vector3d& d_row,
                       double d_right) {
    g += d_row * (right - row.dot(t)) + row * (d_right - d_row.dot(t));
  };
  if (plans_[i].driven)
    add(c.drive_row(), drive_right_side(w.wheels[i], w.readings[i]), d.drive, d.drive_right);
  if (!plans_[i].slides) add(c.side_row(), side_right_side(w.wheels[i], w.readings[i]), d.side, d.side_right);
  return w.normal.solve(g);
}

Eigen::Vector3d WheeledRobot::mean_derivative(const Workspace& w, const BoundField& field) const {
  const WheelNumbers& wheel = w.wheels[field.wheel];
  const WheelReading& r = w.readings[field.wheel];
  const Contact& c = w.contacts[field.wheel];
  double dv = 0, dphi = 0, dpx = 0, dpy = 0;
  switch (field.field) {
    case WheelField::X:
      dpx = 1;
      break;
    case WheelField::Y:
      dpy = 1;
      break;
    case WheelField::Mount:
    case WheelField::Zero:
      dphi = 1;
      break;
    case WheelField::Gain:
      dphi = r.steering;
      break;
    case WheelField::Radius:
      dv = r.drive;
      break;
    case WheelField::Offset:
      dpx = -c.ey, dpy = c.ex;
      break;
    case WheelField::Trail:
      dpx = c.ex, dpy = c.ey;
      break;
    case WheelField::Roller:
      break;  // refused by check()
  }
  dpx += dphi * (-wheel.trail * c.ey - wheel.offset * c.ex);
  dpy += dphi * (wheel.trail * c.ex - wheel.offset * c.ey);
  const double dex = -dphi * c.ey, dey = dphi * c.ex;
  const double squared = c.px * c.px + c.py * c.py, cross = c.px * c.ey - c.py * c.ex;
  const double d_cross = dpx * c.ey - dpy * c.ex + c.px * dey - c.py * dex;
  const double d_squared = 2 * (c.px * dpx + c.py * dpy);
  const double v = wheel.radius * r.drive, share = 1 / static_cast<double>(plans_.size());
  return share * Eigen::Vector3d(dv * c.ex + v * dex, dv * c.ey + v * dey,
                                 (dv * cross + v * (d_cross - cross * d_squared / squared)) / squared);
}

WheelRows WheeledRobot::rows_of(const Workspace& w) const {
  std::vector<Eigen::Vector3d> a;
  std::vector<double> b;
  WheelRows rows;
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    if (plans_[i].driven) {
      a.push_back(w.contacts[i].drive_row());
      b.push_back(drive_right_side(w.wheels[i], w.readings[i]));
      rows.names.push_back(fmt::format("wheel {} drive", i + 1));
    }
    if (!plans_[i].slides) {
      a.push_back(w.contacts[i].side_row());
      b.push_back(side_right_side(w.wheels[i], w.readings[i]));
      rows.names.push_back(fmt::format("wheel {} side", i + 1));
    }
  }
  rows.a.resize(static_cast<Eigen::Index>(a.size()), 3);
  rows.b = Eigen::Map<const Vector>(b.data(), static_cast<Eigen::Index>(b.size()));
  for (std::size_t i = 0; i < a.size(); ++i) rows.a.row(static_cast<Eigen::Index>(i)) = a[i];
  return rows;
}

WheelRows WheeledRobot::rows(const ConstMatrixRef& signals, const ConstVectorRef& z,
                             const Matrix* rates) const {
  check_shape("signals", signals, static_cast<Eigen::Index>(signals_.size()), 1);
  Workspace w = start(signals, z, rates);
  read(w, signals, rates, 0);
  return rows_of(w);
}

Vector WheeledRobot::residual_norms(const ConstMatrixRef& signals, const ConstVectorRef& z,
                                    const Matrix* rates) const {
  Workspace w = start(signals, z, rates);
  Vector norms(signals.cols());
  for (Eigen::Index k = 0; k < signals.cols(); ++k) {
    read(w, signals, rates, k);
    const Eigen::Vector3d t = solve(w, k);
    double sum = 0;
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      const double drive =
          plans_[i].driven ? drive_right_side(w.wheels[i], w.readings[i]) - w.contacts[i].drive_row().dot(t)
                           : 0;
      const double side = plans_[i].slides
                              ? 0
                              : side_right_side(w.wheels[i], w.readings[i]) - w.contacts[i].side_row().dot(t);
      sum += drive * drive + side * side;
    }
    norms[k] = std::sqrt(sum);
  }
  return norms;
}

bool WheeledRobot::mean_equals_least_squares(const ConstVectorRef& z) const {
  constexpr double kTolerance = 1e-12;
  double sum_x = 0, sum_y = 0, least = HUGE_VAL, most = 0;
  const std::vector<WheelNumbers> wheels = numbers(z);
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const WheelNumbers& w = wheels[i];
    if (!plans_[i].driven || plans_[i].slides || !w.steered || w.tangent != 0 || w.offset != 0 ||
        w.trail != 0)
      return false;
    sum_x += w.x;
    sum_y += w.y;
    const double distance = std::hypot(w.x, w.y);
    least = std::min(least, distance);
    most = std::max(most, distance);
  }
  return std::hypot(sum_x, sum_y) <= kTolerance * most && most - least <= kTolerance * most;
}

}  // namespace odobench::robots
