#include "problems/calibration/robust_form.hpp"

#include <cmath>
#include <stdexcept>

namespace odobench {
namespace {

using Eigen::Index;

CalibrationOptions squared(CalibrationOptions options) {
  options.loss = {};
  return options;
}

// e -> f(s) e / scale and its derivatives, for the rows of one group.
void shape_group(const Loss& loss, double scale, VectorRef e, MatrixRef* j, Index first) {
  e /= scale;
  const LossValue at = loss.at(e.squaredNorm());
  if (j != nullptr)
    for (Index column = 0; column < j->cols(); ++column) {
      auto by = j->col(column).segment(first, e.size());
      const double along = 2 * at.slope * e.dot(by) / scale;
      by = (at.factor / scale) * by + along * e;
    }
  e *= at.factor;
}

}  // namespace

RobustForm::RobustForm(const Robot& robot, const std::vector<Recording>& recordings,
                       const CalibrationOptions& options, InstructionSet kernel)
    : squared_(robot, recordings, squared(options), kernel),
      loss_(options.loss),
      row_(options.cost == CostKind::Optiodom ? 2 : 3) {
  const bool one = loss_.scope == LossScope::Recording;
  if (!(loss_.position_scale > 0) || !(one || loss_.heading_scale > 0))
    throw std::invalid_argument("calibration: the scales of a robust loss must be above 0");
}

double RobustForm::recording_cost(double squares, std::size_t n) const {
  const auto rows = static_cast<double>(squared_[n].residual_count() / row_);
  const double unit = rows * loss_.position_scale * loss_.position_scale;
  if (unit == 0) return 0;
  return unit * loss_.at(squares / unit).rho;
}

double robust_cost(const Loss& loss, const ConstVectorRef& e, Index row) {
  if (!loss.robust()) return e.squaredNorm();
  if (loss.scope == LossScope::Recording) {
    const double unit = static_cast<double>(e.size() / row) * loss.position_scale * loss.position_scale;
    return unit == 0 ? 0 : unit * loss.at(e.squaredNorm() / unit).rho;
  }
  const double p = 1 / (loss.position_scale * loss.position_scale),
               h = 1 / (loss.heading_scale * loss.heading_scale);
  double sum = 0;
  for (Index i = 0; i < e.size(); i += row) {
    sum += loss.at(p * (e[i] * e[i] + e[i + 1] * e[i + 1])).rho;
    if (row == 3) sum += loss.at(h * e[i + 2] * e[i + 2]).rho;
  }
  return sum;
}

double RobustForm::cost(const ConstVectorRef& z) const {
  double sum = 0;
  Vector r;
  for (std::size_t n = 0; n < squared_.size(); ++n) {
    if (loss_.scope == LossScope::Recording) {
      sum += recording_cost(squared_[n].cost(z), n);
      continue;
    }
    r.resize(squared_[n].residual_count());
    squared_[n].residuals(z, r);
    sum += robust_cost(loss_, r, row_);
  }
  return sum;
}

void RobustForm::batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const {
  if (loss_.scope == LossScope::Sample) {
    for (Index k = 0; k < candidates.cols(); ++k) costs[k] = cost(candidates.col(k));
    return;
  }
  costs.setZero();
  Vector part(candidates.cols());
  for (std::size_t n = 0; n < squared_.size(); ++n) {
    squared_[n].batch_cost(candidates, part);
    for (Index k = 0; k < part.size(); ++k) costs[k] += recording_cost(part[k], n);
  }
}

void RobustForm::shape_rows(VectorRef r, MatrixRef* j) const {
  for (Index i = 0; i < r.size(); i += row_) {
    shape_group(loss_, loss_.position_scale, r.segment(i, 2), j, i);
    if (row_ == 3) shape_group(loss_, loss_.heading_scale, r.segment(i + 2, 1), j, i + 2);
  }
}

void RobustForm::shape(std::size_t n, VectorRef r, MatrixRef* j) const {
  if (loss_.scope == LossScope::Sample) return shape_rows(r, j);
  if (r.size() == 0) return;
  // In units of sqrt(N) sg, so that s is the mean square in units of sg^2.
  const double unit =
      std::sqrt(static_cast<double>(squared_[n].residual_count() / row_)) * loss_.position_scale;
  shape_group(loss_, unit, r, j, 0);
  r *= unit;
  if (j != nullptr) *j *= unit;
}

void RobustForm::residuals(const ConstVectorRef& z, VectorRef r) const {
  Index row = 0;
  for (std::size_t n = 0; n < squared_.size(); ++n) {
    const Index count = squared_[n].residual_count();
    VectorRef own = r.segment(row, count);
    squared_[n].residuals(z, own);
    shape(n, own, nullptr);
    row += count;
  }
}

void RobustForm::residuals_and_jacobian(const ConstVectorRef& z, VectorRef r, MatrixRef j) const {
  Index row = 0;
  for (std::size_t n = 0; n < squared_.size(); ++n) {
    const Index count = squared_[n].residual_count();
    VectorRef own = r.segment(row, count);
    MatrixRef block = j.middleRows(row, count);
    squared_[n].residuals_and_jacobian(z, own, block);
    shape(n, own, &block);
    row += count;
  }
}

void RobustForm::normal_equations(const ConstVectorRef& z, NormalEquations& out) const {
  const Index n = z.size();
  out.cost = 0;
  out.jtr = Vector::Zero(n);
  out.jtj = Matrix::Zero(n, n);
  NormalEquations part;
  Vector r;
  Matrix j;
  for (std::size_t i = 0; i < squared_.size(); ++i) {
    const CalibrationProblem& one = squared_[i];
    if (one.residual_count() == 0) continue;
    if (loss_.scope == LossScope::Recording) {
      one.normal_equations(z, part);
      const double unit =
          static_cast<double>(one.residual_count() / row_) * loss_.position_scale * loss_.position_scale;
      const double s = part.cost / unit;
      const LossValue at = loss_.at(s);
      out.cost += unit * at.rho;
      out.jtr += at.weight * part.jtr;
      out.jtj += at.factor * at.factor * part.jtj;
      out.jtj += (4 * at.slope * (at.factor + s * at.slope) / unit) * part.jtr * part.jtr.transpose();
      continue;
    }
    r.resize(one.residual_count());
    j.resize(one.residual_count(), n);
    MatrixRef block = j;
    one.residuals_and_jacobian(z, r, block);
    shape_rows(r, &block);
    out.cost += r.squaredNorm();
    out.jtr.noalias() += j.transpose() * r;
    out.jtj.selfadjointView<Eigen::Lower>().rankUpdate(j.transpose());
  }
  out.jtj.triangularView<Eigen::StrictlyUpper>() = out.jtj.transpose();
}

double RobustForm::floor_factor() const {
  if (loss_.scope == LossScope::Recording) return 1;
  const double scale = row_ == 3 ? std::min(loss_.position_scale, loss_.heading_scale) : loss_.position_scale;
  return 1 / (scale * scale);
}

}  // namespace odobench
