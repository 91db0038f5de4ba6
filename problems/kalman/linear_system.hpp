// Exact and truncated discretisation of a linear system with inputs and white noise,
//     x' = A x + B u + G w,      w white with power spectral density Qc,
// for u constant over a period T:
//     x[k+1] = F x[k] + Psi u[k] + noise of covariance Q
//     F = e^{AT},  Psi = int_0^T e^{As} ds B,  Gamma = int_0^T e^{As} ds G,
//     Q = int_0^T e^{As} G Qc G' e^{A's} ds.
// The article "Deriving a dynamic system model for a discrete Kalman filter for an arbitrary linear system"
// (habr.com, article 474150) truncates the series of e^{AT}; here the exact values are computed too, and the
// truncation comes with a bound. The exact form takes one exponential of a block matrix for F, Psi and Gamma
// (no inverse of A) and C. Van Loan's block matrix for Q (IEEE Transactions on Automatic Control 23(3),
// 1978).
#pragma once

#include <string>
#include <vector>

#include "problems/problem.hpp"

namespace odobench {

struct SignalInfo {
  std::string name;
  std::string unit;
  bool angle = false;  // differences are wrapped to (-pi, pi]
};

// n states, m inputs (0 allowed), p noises (0 allowed). A n x n, B n x m, G n x p, qc p x p.
struct LinearSystem {
  std::string name;
  std::vector<SignalInfo> states;
  std::vector<SignalInfo> inputs;
  std::vector<SignalInfo> noises;
  Matrix a, b, g, qc;
};

// Throws std::invalid_argument naming the matrix, what was found and what was expected: A not square or
// empty, rows of B or G that are not those of A, qc of another size than the columns of G, names that do not
// match the sizes, entries that are not finite, qc that is not symmetric or has a negative eigenvalue.
void validate(const LinearSystem& system);

struct Discretisation {
  Matrix f, psi, gamma, q;
};

// Throws std::invalid_argument on a bad system, a period that is not finite and positive, and on a result
// that leaves the range of a double (e^{AT} of a fast unstable system).
Discretisation discretise(const LinearSystem& system, double period);

// Q of noise that is constant over a period with covariance w (p x p): Gamma w Gamma'. With w = Qc/T it
// agrees with the exact Q to O(T) only.
Matrix piecewise_constant_noise(const ConstMatrixRef& gamma, const ConstMatrixRef& w);

// The series cut after order n:
//     F_n = sum_{j<=n} (AT)^j / j!,    int_n = sum_{j<=n} A^j T^{j+1} / (j+1)!,    Psi_n = int_n B,  Gamma_n
//     = int_n G, Q_n = int_0^T F_n(s) G Qc G' F_n(s)' ds, which the sum over T^{i+j+1} / (i! j! (i+j+1))
//     gives exactly.
// Bounds in the 1-norm with theta = |A|_1 T (C. Moler, C. Van Loan, SIAM Review 20(4), 1978, method 1):
//     |F - F_n| <= theta^{n+1} / (n+1)! * r,   |int - int_n| <= T theta^{n+1} / (n+2)! * r,
// r = 1 / (1 - theta/(n+2)) where theta < n+2, else e^theta. Beside the bounds stand the differences to the
// exact matrices, largest entry.
struct SeriesDiscretisation {
  Discretisation value;
  Matrix integral;  // int_n
  double f_bound = 0, integral_bound = 0;
  double f_error = 0, psi_error = 0, gamma_error = 0, q_error = 0;
};

inline constexpr int kMaxSeriesOrder = 170;  // (n+1)! leaves the range of a double above

// order 1..kMaxSeriesOrder - 2; throws std::invalid_argument as discretise does.
SeriesDiscretisation discretise_series(const LinearSystem& system, double period, int order);

}  // namespace odobench
