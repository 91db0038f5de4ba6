// How well the data determine the parameters at a solution: what an honest report must say beside the
// numbers.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "problems/problem.hpp"

namespace odobench {

// With q = z / scale relative parameters (scale: |nominal|, or half the box where nominal is 0), J'J in q and
// N residuals of n free parameters,
//     sigma^2 = J / (N - n),   cov(q) = sigma^2 (J'J)^-1   (linear least-squares theory, bounds ignored)
// as if samples were independent, which those of a drive are not: nothing makes an interval of it.
// problems/trust/ has intervals that hold.
struct Identifiability {
  Vector singular_values;      // of the Jacobian in q, largest first (n)
  Vector standard_deviations;  // relative, of each parameter in the problem's order (n); infinite when
                               // undetermined
  Matrix directions;           // unit vectors in q, a column per singular value
  Matrix correlation;  // cov(q)_ij / sqrt(cov_ii cov_jj) (n x n); not-a-number where a deviation is infinite
  double residual_deviation = 0;         // sigma
  std::vector<Eigen::Index> parameters;  // index of each of the n free parameters
};

// Empty where every parameter is held fixed. Throws std::logic_error when the problem has no residuals.
Identifiability identifiability(const Problem& problem, const ConstVectorRef& x);

// The series of reports/records/record.hpp.
std::map<std::string, std::vector<double>> identifiability_series(const Identifiability& identifiability);

// The combinations whose relative standard deviation along their unit vector exceeds the mean relative half
// width of the boxes, in words (combinations.hpp): "lx against ly".
std::vector<std::string> undetermined_combinations(const Problem& problem,
                                                   const Identifiability& identifiability);

// A sentence or two: spread of the singular values, the parameters whose relative standard deviation exceeds
// half the width of their box, and undetermined_combinations(); "" when every parameter is determined better
// than its box. `what` names the data and the point: "demo, at the result of lm".
std::string identifiability_note(const Problem& problem, const Identifiability& identifiability,
                                 const std::string& what);

}  // namespace odobench
