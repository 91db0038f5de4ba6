#include "problems/kalman/covariance.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <stdexcept>

#include "problems/kalman/triangular.hpp"

namespace odobench {

void require_covariance(const std::string& name, const ConstMatrixRef& p, Definiteness definiteness) {
  if (p.rows() != p.cols() || p.rows() == 0)
    throw std::invalid_argument(
        fmt::format("{} is {} x {}, expected a square matrix", name, p.rows(), p.cols()));
  if (!p.allFinite())
    throw std::invalid_argument(
        fmt::format("{} has an entry that is not finite, expected a covariance", name));
  const double asymmetry = (p - p.transpose()).cwiseAbs().maxCoeff();
  if (asymmetry > 1e-12 * p.cwiseAbs().maxCoeff())
    throw std::invalid_argument(fmt::format(
        "{} is not symmetric: entries differ by {:.3g} from their mirror image", name, asymmetry));
  const Vector values = Eigen::SelfAdjointEigenSolver<Matrix>(p, Eigen::EigenvaluesOnly).eigenvalues();
  const double slack = 1e-14 * static_cast<double>(p.rows()) * values.cwiseAbs().maxCoeff();
  const double least = values.minCoeff();
  const bool positive = definiteness == Definiteness::Positive;
  if (positive ? !(least > 0) : !(least >= -slack))
    throw std::invalid_argument(fmt::format("{} has the eigenvalue {:.6g}, expected {}", name, least,
                                            positive ? "a positive definite covariance" : "none below 0"));
}

Matrix covariance_factor(const std::string& name, const ConstMatrixRef& p, Definiteness definiteness) {
  require_covariance(name, p, definiteness);
  const Eigen::LLT<Matrix> cholesky(p);
  if (cholesky.info() == Eigen::Success) return cholesky.matrixL();
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(p);
  const Matrix root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return lower_triangular<Eigen::Dynamic, Eigen::Dynamic>(root);
}

}  // namespace odobench
