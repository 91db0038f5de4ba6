// From motions per interval to poses.
//
// The motion (dx, dy, dtheta) of interval j, in the body frame, is its twist times its length, or the twist
// of increments:
//     theta_j = theta_{j-1} + dtheta,   (x, y)_j = (x, y)_{j-1} + f R(a) (dx, dy),   h = dtheta / 2
//     euler           a = theta_{j-1}            f = 1           J. Vitko's thesis (3.1)
//     midpoint        a = theta_{j-1} + h        f = 1
//     arc             a = theta_{j-1} + h        f = sin(h) / h  exact for a constant twist
//     optiodom-omni   a = theta_{j-1} + dtheta   f = sin(h) / h  euler where |dtheta| / T < 1e-5 rad/s
// The last is what the programs of OptiOdom (Sousa et al., J. Intell. Robot. Syst. 105:39, 2022) compute for
// omni robots, and turns by half the angle twice: only to reproduce their numbers.
// Sums are prefix sums: headings first, then positions without recurrence. f and its derivative are series
// near 0.
#pragma once

#include <Eigen/Core>

#include "datasets/robots/integration_rule.hpp"
#include "problems/matrices.hpp"

namespace odobench::robots {

// sin(h) / h, and its derivative by h.
double sine_quotient(double h);
double sine_quotient_derivative(double h);

// motions 3 x N; poses 3 x (N + 1), the first is `start` (x, y, theta). `seconds`: lengths T of the intervals
// (N), for optiodom-omni, otherwise not looked at. Throws std::invalid_argument for other shapes, and for T
// <= 0.
void integrate(IntegrationRule rule, const ConstMatrixRef& motions, const Eigen::Vector3d& start,
               MatrixRef poses, const Vector& seconds = {});

// The same, and derivatives: of the motions 3N x n, of the poses 3 (N + 1) x n (rows x, y, theta of the first
// pose, which are 0, of the second, ...). A derivative across the threshold of optiodom-omni is that of the
// side where it lies.
void integrate(IntegrationRule rule, const ConstMatrixRef& motions, const ConstMatrixRef& motions_by,
               const Eigen::Vector3d& start, MatrixRef poses, MatrixRef poses_by, const Vector& seconds = {});

}  // namespace odobench::robots
