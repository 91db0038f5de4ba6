// The twist as matrix times streams, for the robots that have such a form.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "problems/robots/wheeled_robot_workspace.hpp"

namespace odobench::robots {
namespace {

// Both rows of a wheel with right sides as a 2 x S matrix; the rows of a wheel that has fewer are 0.
struct LinearRows {
  explicit LinearRows(Eigen::Index streams) : b(Matrix::Zero(2, streams)) {}
  Eigen::Matrix<double, 2, 3> a = Eigen::Matrix<double, 2, 3>::Zero();
  Matrix b;
};

// Columns: the direction of rolling for the streams of cosine and sine.
Eigen::Matrix2d directions(const WheelNumbers& w) {
  Eigen::Matrix2d r;
  r << w.cosine, -w.sine, w.sine, w.cosine;
  return r;
}
Eigen::Matrix2d directions_by_heading(const WheelNumbers& w) {
  Eigen::Matrix2d r;
  r << -w.sine, -w.cosine, w.cosine, -w.sine;
  return r;
}

// Steered, contact at the pivot: u = radius w e, in the body's axes. Streams `first` and `first` + 1.
LinearRows steered_rows(const WheelNumbers& w, Eigen::Index first, Eigen::Index streams) {
  LinearRows r(streams);
  r.a << 1, 0, -w.y, 0, 1, w.x;
  r.b.middleCols<2>(first) = w.radius * directions(w);
  return r;
}
LinearRows steered_derivatives(const WheelNumbers& w, WheelField field, Eigen::Index first,
                               Eigen::Index streams) {
  LinearRows d(streams);
  if (field == WheelField::X) d.a(1, 2) = 1;
  if (field == WheelField::Y) d.a(0, 2) = -1;
  if (field == WheelField::Mount || field == WheelField::Zero)
    d.b.middleCols<2>(first) = w.radius * directions_by_heading(w);
  if (field == WheelField::Radius) d.b.middleCols<2>(first) = directions(w);
  return d;  // the others are held fixed
}

}  // namespace

bool WheeledRobot::is_constant(std::size_t wheel, WheelField field) const {
  for (const BoundField& f : fields_)
    if (f.wheel == wheel && f.field == field)
      return std::all_of(f.terms.begin(), f.terms.end(), [this](const Term& term) {
        const RobotParameter& p = parameters_[static_cast<std::size_t>(term.parameter)];
        return p.lower == p.upper;
      });
  return true;
}

bool WheeledRobot::is_zero(std::size_t wheel, WheelField field) const {
  if (!is_constant(wheel, field)) return false;
  double value = field_of(table_.wheels[wheel], field);
  for (const BoundField& f : fields_)
    if (f.wheel == wheel && f.field == field)
      for (const Term& term : f.terms)
        value += term.factor * parameters_[static_cast<std::size_t>(term.parameter)].nominal;
  return value == 0;
}

void WheeledRobot::plan_streams() {
  const auto zero = [this](std::size_t wheel, std::initializer_list<WheelField> fields) {
    return std::all_of(fields.begin(), fields.end(), [&](WheelField f) { return is_zero(wheel, f); });
  };
  using enum WheelField;
  std::vector<std::size_t> stating;  // wheels that have rows
  bool all = true;
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    const Plan& plan = plans_[i];
    if (!plan.driven && plan.slides) continue;
    stating.push_back(i);
    const bool plain =
        plan.driven && !plan.slides && zero(i, {Roller, Offset, Trail}) && is_constant(i, Gain);
    all = all && (plan.steering < 0 || plain);
    if (!plan.driven) continue;
    if (plan.steering < 0) {
      streams_.push_back({i, StreamKind::Drive, i});
    } else {
      streams_.push_back({i, StreamKind::Cosine, i});
      streams_.push_back({i, StreamKind::Sine, i});
    }
  }
  if (all) {
    form_ = LinearForm::Wheels;
    return;
  }
  streams_.clear();
  if (stating.size() != 2) return;
  if (!plans_[stating[0]].driven) std::swap(stating[0], stating[1]);
  const std::size_t rear = stating[0], front = stating[1];
  const Plan &r = plans_[rear], &f = plans_[front];
  if (!r.driven || r.slides || r.steering >= 0 || f.driven || f.slides || f.steering < 0) return;
  if (!zero(rear, {X, Y, Mount, Roller, Offset, Trail})) return;
  if (!zero(front, {Y, Mount, Zero, Offset, Trail}) || !is_constant(front, Gain)) return;
  form_ = LinearForm::Bicycle;
  streams_ = {{rear, StreamKind::Drive, rear}, {rear, StreamKind::Tangent, front}};
}

void WheeledRobot::check_linear(const ConstVectorRef& z) const {
  if (!is_linear()) throw std::logic_error("robot: its twist is not linear in streams without parameters");
  for (std::size_t i = 0; i < parameters_.size() && z.size() == static_cast<Eigen::Index>(parameters_.size());
       ++i) {
    const RobotParameter& p = parameters_[i];
    const double value = z[static_cast<Eigen::Index>(i)];
    if (p.lower == p.upper && value != p.nominal)
      throw std::invalid_argument(
          fmt::format("robot: parameter '{}' is held fixed at {}, found {}", p.name, p.nominal, value));
  }
}

Matrix WheeledRobot::streams(const ConstMatrixRef& signals) const {
  const Vector fixed = nominal();
  check_linear(fixed);
  check_signals(signals, nullptr);
  const std::vector<WheelNumbers> wheels = numbers(fixed);  // for the gains, which are constant
  Matrix result(stream_count(), signals.cols());
  for (Eigen::Index k = 0; k < signals.cols(); ++k) {
    for (Eigen::Index i = 0; i < stream_count(); ++i) {
      const Stream& stream = streams_[static_cast<std::size_t>(i)];
      double drive = 0;
      for (const auto& [row, weight] : plans_[stream.wheel].drives) drive += weight * signals(row, k);
      const Eigen::Index steering = plans_[stream.steered_by].steering;
      const double angle = steering < 0 ? 0 : wheels[stream.steered_by].gain * signals(steering, k);
      switch (stream.kind) {
        case StreamKind::Drive:
          break;
        case StreamKind::Cosine:
          drive *= std::cos(angle);
          break;
        case StreamKind::Sine:
          drive *= std::sin(angle);
          break;
        case StreamKind::Tangent:
          drive *= std::tan(angle);
          break;
      }
      result(i, k) = drive;
    }
  }
  return result;
}

Matrix WheeledRobot::matrix(const ConstVectorRef& z) const {
  Matrix m;
  linear_form(z, m, nullptr);
  return m;
}

void WheeledRobot::matrix_and_derivatives(const ConstVectorRef& z, Matrix& m, std::vector<Matrix>& d) const {
  linear_form(z, m, &d);
}

void WheeledRobot::linear_form(const ConstVectorRef& z, Matrix& m, std::vector<Matrix>* d) const {
  check_linear(z);
  const std::vector<WheelNumbers> wheels = numbers(z);
  m = Matrix::Zero(3, stream_count());
  if (d) d->assign(parameters_.size(), m);
  if (form_ == LinearForm::Bicycle)
    bicycle_matrix(wheels, m, d);
  else if (table_.rule == TwistRule::Mean)
    mean_matrix(wheels, m, d);
  else
    wheels_matrix(wheels, m, d);
  if (!d) return;
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    if (parameters_[i].lower == parameters_[i].upper) (*d)[i].setZero();
}

// (2): v = r w, omega = v tan(steering) / l, with r of the rear wheel and l = x of the front wheel.
void WheeledRobot::bicycle_matrix(const std::vector<WheelNumbers>& wheels, Matrix& m,
                                  std::vector<Matrix>* d) const {
  const double r = wheels[streams_[0].wheel].radius, l = wheels[streams_[1].steered_by].x;
  if (l == 0) throw std::invalid_argument("robot: wheelbase 0");
  m(0, 0) = r;
  m(2, 1) = r / l;
  if (!d) return;
  for (const BoundField& f : fields_)
    for (const Term& term : f.terms) {
      Matrix& by = (*d)[static_cast<std::size_t>(term.parameter)];
      if (f.wheel == streams_[0].wheel && f.field == WheelField::Radius) {
        by(0, 0) += term.factor;
        by(2, 1) += term.factor / l;
      }
      if (f.wheel == streams_[1].steered_by && f.field == WheelField::X)
        by(2, 1) -= term.factor * r / (l * l);
    }
}

// M = (A'A)^-1 A'B; dM = (A'A)^-1 (dA'(B - A M) + A'(dB - dA M)).
void WheeledRobot::wheels_matrix(const std::vector<WheelNumbers>& wheels, Matrix& m,
                                 std::vector<Matrix>* d) const {
  const Eigen::Index count = stream_count();
  std::vector<Eigen::Index> first(wheels.size(), 0);
  for (Eigen::Index s = count; s-- > 0;) first[streams_[static_cast<std::size_t>(s)].wheel] = s;
  std::vector<LinearRows> rows(wheels.size(), LinearRows(count));
  Eigen::Matrix3d n = Eigen::Matrix3d::Zero();
  Matrix h = Matrix::Zero(3, count);
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const WheelNumbers& w = wheels[i];
    if (w.steered && plans_[i].driven) {
      rows[i] = steered_rows(w, first[i], count);
    } else {
      const Contact c = contact(w, 0);
      if (plans_[i].driven) rows[i].a.row(0) = c.drive_row();
      if (plans_[i].driven) rows[i].b(0, first[i]) = w.radius;
      if (!plans_[i].slides) rows[i].a.row(1) = c.side_row();
    }
    n += rows[i].a.transpose() * rows[i].a;
    h += rows[i].a.transpose() * rows[i].b;
  }
  const Cholesky3 normal(n);
  for (Eigen::Index s = 0; s < count; ++s) m.col(s) = normal.solve(h.col(s));
  if (!d) return;
  for (const BoundField& f : fields_) {
    const WheelNumbers& w = wheels[f.wheel];
    LinearRows by(count);
    if (w.steered && plans_[f.wheel].driven) {
      by = steered_derivatives(w, f.field, first[f.wheel], count);
    } else {
      const RowDerivatives row = row_derivatives(w, contact(w, 0), {1, 0, 0}, f.field);
      if (plans_[f.wheel].driven) by.a.row(0) = row.drive;
      if (plans_[f.wheel].driven) by.b(0, first[f.wheel]) = row.drive_right;
      if (!plans_[f.wheel].slides) by.a.row(1) = row.side;
    }
    const LinearRows& r = rows[f.wheel];
    const Matrix g = by.a.transpose() * (r.b - r.a * m) + r.a.transpose() * (by.b - by.a * m);
    for (const Term& term : f.terms)
      for (Eigen::Index s = 0; s < count; ++s)
        (*d)[static_cast<std::size_t>(term.parameter)].col(s) += term.factor * normal.solve(g.col(s));
  }
}

// Of the contact at the pivot: 1/N radius (e, (p x e) / |p|^2) for either stream of a wheel.
void WheeledRobot::mean_matrix(const std::vector<WheelNumbers>& wheels, Matrix& m,
                               std::vector<Matrix>* d) const {
  const double share = 1 / static_cast<double>(wheels.size());
  const auto turning = [](double x, double y, const Eigen::Matrix2d& e) {  // p x e
    return Eigen::RowVector2d(x * e.row(1) - y * e.row(0));
  };
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const WheelNumbers& w = wheels[i];
    const double squared = w.x * w.x + w.y * w.y;
    if (!(squared > 0))
      throw std::invalid_argument(
          fmt::format("robot: wheel {} stands at the origin, where the mean has no rotation", i + 1));
    const Eigen::Matrix2d e = directions(w);
    const Eigen::RowVector2d cross = turning(w.x, w.y, e);
    const auto columns = static_cast<Eigen::Index>(2 * i);
    m.block<2, 2>(0, columns) = share * w.radius * e;
    m.block<1, 2>(2, columns) = share * w.radius / squared * cross;
    if (!d) continue;
    for (const BoundField& f : fields_) {
      if (f.wheel != i) continue;
      Eigen::Matrix<double, 3, 2> by = Eigen::Matrix<double, 3, 2>::Zero();
      const double scale = share * w.radius / squared;
      if (f.field == WheelField::X) by.row(2) = scale * (e.row(1) - 2 * w.x / squared * cross);
      if (f.field == WheelField::Y) by.row(2) = scale * (-e.row(0) - 2 * w.y / squared * cross);
      if (f.field == WheelField::Radius) by << share * e, share / squared * cross;
      if (f.field == WheelField::Mount || f.field == WheelField::Zero) {
        const Eigen::Matrix2d turned = directions_by_heading(w);
        by << share * w.radius * turned, scale * turning(w.x, w.y, turned);
      }
      for (const Term& term : f.terms)
        (*d)[static_cast<std::size_t>(term.parameter)].middleCols<2>(columns) += term.factor * by;
    }
  }
}

}  // namespace odobench::robots
