#include "solvers/box/linear_model.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "solvers/box/box_least_squares.hpp"

namespace odobench {

LinearModel linear_model(const NormalEquations& e) {
  const Eigen::Index m = e.jtr.size();
  const double norm = std::sqrt(e.cost);
  LinearModel model;
  model.cost = e.cost;
  const Vector length = e.jtj.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Vector inverse = (length.array() > 0).select(1.0 / length.array(), 0.0);
  model.size = length / norm;
  // One factor after the other: the products of the small and the large ones may leave the range of doubles.
  const Matrix correlation = inverse.asDiagonal() * e.jtj * inverse.asDiagonal();
  const Vector cosine = (inverse.asDiagonal() * e.jtr) / norm;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(correlation);
  const double noise =
      1e-13 * static_cast<double>(m) * std::max(eigen.eigenvalues().cwiseAbs().maxCoeff(), 1.0);
  const Eigen::Index dropped = (eigen.eigenvalues().array() <= noise).count();
  const Eigen::Index zero = (length.array() == 0).count();
  model.truncated = dropped > zero;
  const Eigen::Index kept = m - dropped;
  const Vector root = eigen.eigenvalues().tail(kept).cwiseSqrt();
  const Matrix vectors = eigen.eigenvectors().rightCols(kept);
  model.a = root.asDiagonal() * vectors.transpose();
  model.b = root.cwiseInverse().asDiagonal() * (vectors.transpose() * cosine);
  return model;
}

LinearModel linear_model(const ConstVectorRef& r, const ConstMatrixRef& j) {
  const double norm = r.stableNorm();
  LinearModel model;
  model.cost = norm * norm;
  Matrix unit = j;
  Vector length(j.cols());
  for (Eigen::Index i = 0; i < j.cols(); ++i) {
    length[i] = j.col(i).stableNorm();
    if (length[i] > 0) unit.col(i) /= length[i];
  }
  model.size = length / norm;
  const Vector target = r / norm;
  if (unit.rows() <= unit.cols()) {
    model.a = std::move(unit);
    model.b = target;
    return model;
  }
  Eigen::HouseholderQR<Matrix> qr(std::move(unit));
  const Vector rotated = qr.householderQ().adjoint() * target;
  model.a = qr.matrixQR().topRows(j.cols()).triangularView<Eigen::Upper>();
  model.b = rotated.head(j.cols());
  return model;
}

double promised_gain(const LinearModel& model, const Vector& lower, const Vector& upper) {
  const Vector y = solve_box_least_squares(model.a, model.b, model.size.cwiseProduct(lower),
                                           model.size.cwiseProduct(upper));
  const Vector change = model.a * y;
  return std::clamp(-(2.0 * model.b.dot(change) + change.squaredNorm()), 0.0, 1.0);
}

}  // namespace odobench
