#include "solvers/box/box_least_squares.hpp"

#include <Eigen/QR>

#include "solvers/box/box_active_set.hpp"

namespace odobench {
namespace {

struct LeastSquares {
  LeastSquares(const Matrix& matrix, const Vector& constant)
      : a(matrix), b(constant), sizes(matrix.colwise().norm()) {}
  const Matrix& a;
  const Vector& b;
  Vector sizes;
  Vector gradient(const Vector& d) const { return a.transpose() * (a * d + b); }
  Vector free_step(const Indices& free, const Vector& d, const Vector&) const {
    // Columns of length one: the rank then does not depend on the units of the parameters.
    Vector scale(static_cast<Eigen::Index>(free.size()));
    for (std::size_t k = 0; k < free.size(); ++k)
      scale[static_cast<Eigen::Index>(k)] = sizes[free[k]] > 0 ? 1.0 / sizes[free[k]] : 0.0;
    Eigen::ColPivHouseholderQR<Matrix> qr;
    qr.setThreshold(1e-14);
    qr.compute(a(Eigen::all, free) * scale.asDiagonal());
    return -(scale.asDiagonal() * qr.solve(a * d + b));
  }
  double size(Eigen::Index i) const { return sizes[i]; }
};

}  // namespace

Vector solve_box_least_squares(const Matrix& a, const Vector& b, const Vector& lower, const Vector& upper) {
  const LeastSquares model(a, b);
  return minimise_on_box(model, a.transpose() * b, lower, upper);
}

}  // namespace odobench
