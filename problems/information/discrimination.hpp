// Which of two models of a robot is right: what a drive that is yet to be made would say.
//
// Models a and b, each fitted to the same recordings, predict that a drive ends at e_a and e_b. How far the
// fits leave each prediction open is P = G C G' with the derivative G of the end pose by the model's free
// parameters and their covariance C. With the scatter S of a single drive's end, n drives decide by
//     D^2(n) = d'(S / n + P_a + P_b)^-1 d,   d = e_a - e_b:
// what is left between the models when both may still bend within what the recordings leave them. That is
// the T-criterion of A. C. Atkinson, V. V. Fedorov, Biometrika 62(1), 1975, with the old recordings as the
// prior of the parameters (P_b: what the wrong model may absorb), and with the error of the prediction by
// the right one (P_a); D^2 / 2 is the expected logarithm of the Bayes factor of two Gaussians with that
// covariance (G. E. P. Box, W. J. Hill, Technometrics 9(1), 1967). Choosing the model that predicts the
// drives better is then right with probability Phi(D / 2).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "problems/calibration/recording_costs.hpp"

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

// C of all parameters at a fit z of a calibration, whose recordings are the unit of information, with the box
// as a prior (variances B of uniform distributions in it, in units of a residual's s^2 = J / m, m =
// effective_residuals()): with g_n, H_n of each recording, R = s^2 B^-1 and H = sum H_n + R
//     C = (G-1)/G sum d_n d_n' + s^2 H^-1 R H^-1,   d_n = (H - H_n)^-1 (g_n - mean g),
// moves when a recording is left out (problems/trust/covariances.hpp) and what the box alone holds. 0 for
// parameters that are held; a fit without error has C = 0.
Matrix fitted_covariance(const RecordingCosts& recordings, const CalibrationProblem& problem,
                         const ConstVectorRef& z);

}  // namespace odobench
