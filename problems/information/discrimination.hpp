// Which of two models of a robot is right: what a drive that is yet to be made would say.
//
// Models a and b, each fitted to the same recordings, predict that a drive ends at e_a and e_b. How far the
// fits leave each prediction open is P = G C G' with the derivative G of the end pose by the model's free
// parameters and their covariance C. With the scatter S of a single drive's end, n drives decide by
//     D^2(n) = min over m in {a, b} of  d'(S / n + P_m)^-1 d,   d = e_a - e_b:
// what remains between the models when the wrong one may still bend within what the recordings leave it. That
// is the T-criterion of A. C. Atkinson, V. V. Fedorov, Biometrika 62(1), 1975, with the old recordings as the
// prior of the wrong model's parameters; D^2 / 2 is the expected logarithm of the Bayes factor between them
// where P is alike for both (G. E. P. Box, W. J. Hill, Technometrics 9(1), 1967). Choosing the model that
// predicts the drives better is then right with probability Phi(D / 2).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "problems/calibration/calibration_problem.hpp"

namespace odobench {

struct EndPrediction {
  Eigen::Vector3d end;   // x, y (m), heading (rad) in the frame of the start
  Eigen::Matrix3d open;  // P
};

struct Discrimination {
  Eigen::Vector3d difference;  // d
  Eigen::Matrix3d scatter;     // S
  Eigen::Matrix3d open_a, open_b;

  // D of n drives (n > 0).
  double separation(double n) const;
  // The least n with probability_right(n) >= wanted; nothing where `most` do not do.
  std::optional<int> repetitions(double wanted = 0.95, int most = 100) const;
};

// S is symmetric and positive definite.
Discrimination discriminate(const EndPrediction& a, const EndPrediction& b, const Eigen::Matrix3d& scatter);

// Phi(D / 2).
double probability_right(double separation);

// How many independent numbers the residuals of recordings are worth at z: of each recording and each of x,
// y, heading n / (1 + 2 sum rho_k), rho uncentred and up to its first zero, summed over recordings; from at
// most 400 stamps of each, evenly spread.
double effective_residuals(const CalibrationProblem& problem, const ConstVectorRef& z);

// C of all parameters at a fit z: (H m / J + B^-1)^-1 with H = J'J, m = effective_residuals() and B the
// variances of uniform distributions in the boxes; 0 for parameters that are held. A fit without error has C
// = 0.
Matrix fitted_covariance(const CalibrationProblem& problem, const ConstVectorRef& z);

}  // namespace odobench
