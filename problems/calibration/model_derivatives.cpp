// Errors and derivatives of a pass: see model_form.hpp.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "base/angle.hpp"
#include "problems/calibration/model_pass.hpp"

namespace odobench {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// The rows of the reference that a lane of a pass is at: act(step, row, place of its errors in Pass::errors).
template <class Drive, class Pass, class Act>
void for_each_row(const Drive& drive, const Pass& pass, int lane, const Act& act) {
  for (Index step = 0; step < pass.task.steps; ++step) {
    const Index k = lane * pass.task.steps + step;
    if (k >= pass.intervals) break;
    const int row = drive.row_of[static_cast<std::size_t>(k)];
    if (row >= 0) act(step, row, step * kernel::kErrors * pass.width + lane);
  }
}

}  // namespace

// Newton's method for the start that J is least at, from the usual one; in the recording's own rows.
Vector3d ModelForm::fit_start(const Drive& drive, const Point& at, const Pass& pass) const {
  const double weight = heading_weight() / options_.position_weight;
  std::vector<Vector3d> places;
  for (std::size_t k = 0; k < drive.row_of.size(); ++k)
    if (drive.row_of[k] >= 0) places.push_back(pass.tracked(static_cast<Index>(k), at.lever));
  Vector3d shift = Vector3d::Zero();
  for (int iteration = 0; iteration < 20; ++iteration) {
    const double angle = drive.start[2] - at.yaw + shift[2], c = std::cos(angle), s = std::sin(angle);
    Matrix3d h = Matrix3d::Zero();
    Vector3d g = Vector3d::Zero();
    double gauss = 0;  // of h(2, 2) without second derivatives
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto column = static_cast<Index>(i) + 1;
      const Vector2d p(c * places[i][0] - s * places[i][1], s * places[i][0] + c * places[i][1]);
      const Vector2d e = drive.start.head<2>() + shift.head<2>() + p - drive.reference.col(column).head<2>();
      double et = drive.start[2] + shift[2] + places[i][2] - drive.reference(2, column);
      if (drive.wrapped) et = wrapped_angle(et);
      g += Vector3d(e[0], e[1], p[0] * e[1] - p[1] * e[0] + weight * et);
      h(0, 2) -= p[1];
      h(1, 2) += p[0];
      gauss += p.squaredNorm() + weight;
      h(2, 2) += p.squaredNorm() + weight - p.dot(e);
    }
    h(0, 0) = h(1, 1) = static_cast<double>(places.size());
    h(2, 0) = h(0, 2);
    h(2, 1) = h(1, 2);
    Eigen::LDLT<Matrix3d> solver(h);
    if (!solver.isPositive() || solver.info() != Eigen::Success) {
      h(2, 2) = gauss;
      solver.compute(h);
    }
    const Vector3d step = solver.solve(-g);
    if (!step.allFinite()) break;
    shift += step;
    if (step.head<2>().norm() < 1e-15 * (1 + shift.head<2>().norm()) && std::abs(step[2]) < 1e-15) break;
  }
  return shift;
}

void ModelForm::find_errors(const Drive& drive, const Point& at, bool free_start, Pass& pass) const {
  const double weight = heading_weight() / options_.position_weight;
  pass.start = drive.start;
  if (free_start) pass.start += fit_start(drive, at, pass);
  pass.frame = pass.start[2] - at.yaw;
  pass.errors.assign(static_cast<std::size_t>(pass.task.steps * kernel::kErrors * pass.width), 0.0);
  const Vector3d origin(pass.start[0], pass.start[1], pass.frame);
  double squares = 0;
  for (int lane = 0; lane < pass.width; ++lane) {
    Vector3d from = pass.lanes[static_cast<std::size_t>(lane)];
    from.head<2>() -= at.lever;
    const Vector3d begin = composed(origin, from);
    const double c = std::cos(begin[2]), s = std::sin(begin[2]);
    Pass::Sums sums;
    for_each_row(drive, pass, lane, [&](Index step, int row, Index place) {
      const Vector2d p = pass.in_lane(step, lane, at.lever);
      const double wx = begin[0] + c * p[0] - s * p[1] - drive.reference(0, row),
                   wy = begin[1] + s * p[0] + c * p[1] - drive.reference(1, row);
      double et =
          pass.start[2] + from[2] + pass.at(step, kernel::kHeadingSum, lane) - drive.reference(2, row);
      if (drive.wrapped) et = wrapped_angle(et);
      const double ex = c * wx + s * wy, ey = c * wy - s * wx;
      double* to = pass.errors.data() + place;
      to[0] = ex;
      to[pass.width] = ey;
      to[2 * pass.width] = et;
      to[3 * pass.width] = 1;
      squares += wx * wx + wy * wy + weight * et * et;
      sums.n += 1;
      sums.px += p[0];
      sums.py += p[1];
      sums.pp += p.squaredNorm();
      sums.ex += ex;
      sums.ey += ey;
      sums.qpe += p[0] * ey - p[1] * ex;
      sums.et += weight * et;
      sums.pe += p[0] * ex + p[1] * ey;
    });
    pass.sums.push_back(sums);
  }
  pass.squares = squares;
}

// sigma of the first lane: columns of the parameters, then x, y, heading of the start.
Matrix ModelForm::start_columns(const Point& at, const Pass& pass) const {
  Matrix sigma = Matrix::Zero(3, columns_ + 3);
  const double c = std::cos(pass.frame), s = std::sin(pass.frame);
  const Vector2d turned(-at.lever[1], at.lever[0]);  // Q l
  if (lever_ >= 0) {
    sigma(0, lever_) = -1;
    sigma(1, lever_ + 1) = -1;
  }
  if (yaw_ >= 0) sigma.col(yaw_) << turned[0], turned[1], -1;
  sigma.col(columns_) << c, -s, 0;
  sigma.col(columns_ + 1) << s, c, 0;
  sigma.col(columns_ + 2) << -turned[0], -turned[1], 1;
  return sigma;
}

void ModelForm::next_lane(const Pass& pass, int lane, const double* sums, Matrix& sigma) const {
  const Vector3d end = pass.end(lane);
  const double c = std::cos(end[2]), s = std::sin(end[2]);
  for (Index j = 0; j < sigma.cols(); ++j) {
    Vector3d v = sigma.col(j);
    v[0] -= end[1] * sigma(2, j);
    v[1] += end[0] * sigma(2, j);
    if (j < columns_)
      for (int e = 0; e < 3; ++e) v[e] += sums[(j * kernel::kColumnSums + 6 + e) * pass.width + lane];
    sigma.col(j) << c * v[0] + s * v[1], c * v[1] - s * v[0], v[2];
  }
}

void ModelForm::add_normal(const Drive& drive, const Point& at, NormalEquations& out) const {
  Pass pass = walk(drive, at);
  find_errors(drive, at, free_starts(), pass);
  const auto n = static_cast<int>(columns_);
  const double weight = pass.task.heading_weight;
  std::vector<double> sums(static_cast<std::size_t>(kernel::model_sums(n) * pass.width));
  kernel_.columns(pass.task, pass.walk.data(), pass.errors.data(), sums.data());

  const Index all = columns_ + (free_starts() ? 3 : 0);
  Matrix jtj = Matrix::Zero(all, all);
  Vector jtr = Vector::Zero(all), twisted = Vector::Zero(all);  // twisted: sum e . Q d position
  Matrix sigma = start_columns(at, pass).leftCols(all);
  Matrix b(3, all);
  for (int lane = 0; lane < pass.width; ++lane) {
    const Pass::Sums& s = pass.sums[static_cast<std::size_t>(lane)];
    const auto of = [&](Index j, int e) {
      return sums[static_cast<std::size_t>((j * kernel::kColumnSums + e) * pass.width + lane)];
    };
    Matrix3d c;
    c << s.n, 0, -s.py, 0, s.n, s.px, -s.py, s.px, s.pp + weight * s.n;
    b.setZero();
    for (Index j = 0; j < columns_; ++j) {
      b.col(j) << of(j, 1), of(j, 2), of(j, 4) + weight * of(j, 3);
      jtr[j] += of(j, 0);
      twisted[j] += of(j, 5);
    }
    jtr.noalias() += sigma.transpose() * Vector3d(s.ex, s.ey, s.qpe + s.et);
    twisted.noalias() += sigma.transpose() * Vector3d(s.ey, -s.ex, -s.pe);
    const double* triangle = sums.data() + n * kernel::kColumnSums * pass.width + lane;
    for (Index i = 0; i < columns_; ++i)
      for (Index j = 0; j <= i; ++j, triangle += pass.width) jtj(i, j) += *triangle;
    const Matrix mixed = sigma.transpose() * (b + 0.5 * (c * sigma));
    jtj += mixed + mixed.transpose();
    next_lane(pass, lane, sums.data(), sigma);
  }
  jtj.triangularView<Eigen::StrictlyUpper>() = jtj.transpose();
  out.cost += options_.position_weight * pass.squares;
  if (free_starts()) {
    Matrix3d h = jtj.bottomRightCorner<3, 3>();
    Matrix mixed = jtj.bottomLeftCorner(3, columns_);
    h(2, 2) += twisted[columns_ + 2];
    mixed.row(2) += twisted.head(columns_).transpose();
    const Matrix by = -h.ldlt().solve(mixed);  // of the start by z
    const Matrix cross = jtj.topRightCorner(columns_, 3) * by;
    const Matrix reduced = jtj.topLeftCorner(columns_, columns_) + cross + cross.transpose() +
                           by.transpose() * jtj.bottomRightCorner<3, 3>() * by;
    const Vector gradient = jtr.head(columns_) + by.transpose() * jtr.tail<3>();
    out.jtj += options_.position_weight * reduced;
    out.jtr += options_.position_weight * gradient;
    return;
  }
  out.jtj += options_.position_weight * jtj;
  out.jtr += options_.position_weight * jtr;
}

void ModelForm::put_residuals(const Drive& drive, const Pass& pass, VectorRef r) const {
  const double position = std::sqrt(options_.position_weight), heading = std::sqrt(options_.heading_weight);
  for (int lane = 0; lane < pass.width; ++lane) {
    const double angle = pass.frame + pass.lanes[static_cast<std::size_t>(lane)][2], c = std::cos(angle),
                 s = std::sin(angle);
    for_each_row(drive, pass, lane, [&](Index, int row, Index place) {
      const double* e = pass.errors.data() + place;
      const Index first = per_row() * (row - 1);
      r[first] = position * (c * e[0] - s * e[pass.width]);
      r[first + 1] = position * (s * e[0] + c * e[pass.width]);
      if (per_row() == 3) r[first + 2] = heading * e[2 * pass.width];
    });
  }
}

void ModelForm::write_rows(const Drive& drive, const Point& at, VectorRef r, MatrixRef j) const {
  Pass pass = walk(drive, at);
  find_errors(drive, at, free_starts(), pass);
  put_residuals(drive, pass, r);
  const auto n = static_cast<int>(columns_);
  std::vector<double> sums(static_cast<std::size_t>(kernel::model_sums(n) * pass.width)),
      local(static_cast<std::size_t>(pass.task.steps * n * 3 * pass.width));
  kernel_.rows(pass.task, pass.walk.data(), local.data(), sums.data());
  const double position = std::sqrt(options_.position_weight), heading = std::sqrt(options_.heading_weight);
  const Index all = columns_ + 3;
  Matrix sigma = start_columns(at, pass), by_start(r.size(), 3);
  double twist_start = 0;
  Eigen::RowVectorXd twisted = Eigen::RowVectorXd::Zero(columns_);
  for (int lane = 0; lane < pass.width; ++lane) {
    const double angle = pass.frame + pass.lanes[static_cast<std::size_t>(lane)][2], c = std::cos(angle),
                 s = std::sin(angle);
    for_each_row(drive, pass, lane, [&](Index step, int row, Index place) {
      const Vector2d p = pass.in_lane(step, lane, at.lever);
      const double* e = pass.errors.data() + place;
      const Index first = per_row() * (row - 1);
      for (Index q = 0; q < all; ++q) {
        Vector3d v(sigma(0, q) - p[1] * sigma(2, q), sigma(1, q) + p[0] * sigma(2, q), sigma(2, q));
        if (q < columns_)
          for (int i = 0; i < 3; ++i)
            v[i] += local[static_cast<std::size_t>(((step * n + q) * 3 + i) * pass.width + lane)];
        const Vector3d out(position * (c * v[0] - s * v[1]), position * (s * v[0] + c * v[1]),
                           heading * v[2]);
        const double twist = position * position * (v[0] * e[pass.width] - v[1] * e[0]);
        if (q < columns_) {
          j.block(first, q, per_row(), 1) = out.head(per_row());
          twisted[q] += twist;
        } else {
          by_start.block(first, q - columns_, per_row(), 1) = out.head(per_row());
          if (q == columns_ + 2) twist_start += twist;
        }
      }
    });
    next_lane(pass, lane, sums.data(), sigma);
  }
  if (!free_starts()) return;
  Matrix3d h = by_start.transpose() * by_start;
  h(2, 2) += twist_start;
  Matrix mixed = by_start.transpose() * j;
  mixed.row(2) += twisted;
  j -= by_start * h.ldlt().solve(mixed);
}

}  // namespace odobench
