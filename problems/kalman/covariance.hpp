// Covariances are checked where they enter and kept as factors from there on.
#pragma once

#include <string>

#include "problems/problem.hpp"

namespace odobench {

enum class Definiteness { Positive, Semidefinite };

// Throws std::invalid_argument "NAME is ..." unless p is square, finite, symmetric (to 1e-12 of its largest
// entry) and, by its eigenvalues, positive definite or positive semidefinite; rounding of 1e-14 n of the
// largest eigenvalue is forgiven for Semidefinite only. Nothing is repaired.
void require_covariance(const std::string& name, const ConstMatrixRef& p, Definiteness definiteness);

// A lower-triangular s with s s' = p and no negative entry on its diagonal. Checks like require_covariance
// first; zero eigenvalues are allowed with Semidefinite.
Matrix covariance_factor(const std::string& name, const ConstMatrixRef& p,
                         Definiteness definiteness = Definiteness::Semidefinite);

}  // namespace odobench
