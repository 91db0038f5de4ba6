#include "solvers/box/box_quadratic.hpp"

#include <Eigen/Cholesky>

#include "solvers/box/box_active_set.hpp"

namespace odobench {
namespace {

struct Quadratic {
  const Matrix& h;
  const Vector& g;
  Vector gradient(const Vector& d) const { return g + h * d; }
  Vector free_step(const Indices& free, const Vector&, const Vector& gradient_at_d) const {
    const Matrix hf = h(free, free);
    const Vector gf = gradient_at_d(free);
    return -Eigen::LDLT<Matrix>(hf).solve(gf);
  }
  double size(Eigen::Index i) const { return std::sqrt(h(i, i)); }
};

}  // namespace

Vector solve_box_quadratic(const Matrix& h, const Vector& g, const Vector& lower, const Vector& upper) {
  const Quadratic model{h, g};
  return minimise_on_box(model, g, lower, upper);
}

}  // namespace odobench
