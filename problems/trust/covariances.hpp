// Covariances of a least-squares solution from the scores g_n and informations H_n of independent recordings.
//
// With H = sum H_n, A = H^-1 over G recordings, k of them in a kind, K kinds, N residuals, n parameters:
//   naive          J / (N - n) A                            residuals taken for independent: they are not
//   sandwich       G/(G-1) A (sum g_n g_n') A
//   CR2            A (sum h_n h_n') A,  h_n = (I - H_n A)^-1/2 g_n
//   CR3            (G-1)/G sum d_n d_n', d_n = (H - H_n)^-1 g_n      the jackknife, to first order
//   stratified     A (sum over kinds of k/(k-1) sum (g_n - mean)(g_n - mean)') A
//   between kinds  K/(K-1) A (sum over kinds of s s') A, s the sum of the kind's g_n
// and the degrees of freedom of the variance of c'q by Satterthwaite (R. M. Bell, D. F. McCaffrey, Survey
// Methodology 28, 2002): w_n = (I - A H_n)^-p A c with p = 1/2 (CR2) or 1 (CR3), M_nm = w_n'(delta_nm H_n -
// H_n A H_m) w_m, df = (trace M)^2 / sum M_nm^2.
//
// All by whitened coordinates p, q = B p with B'H B = I: powers are those of symmetric matrices, and
// directions that the data cannot tell (eigenvalues of H, scaled to a unit diagonal, up to 1e-14 n times the
// largest) are left out of B.
#pragma once

#include <string>
#include <vector>

#include "problems/matrices.hpp"

namespace odobench {

class RecordingCovariances {
 public:
  // g: G vectors (n), h: G symmetric matrices (n x n). Throws std::invalid_argument where there are none, or
  // not as many, or of other sizes.
  RecordingCovariances(const std::vector<Vector>& g, const std::vector<Matrix>& h);

  // n x n. Throws std::invalid_argument for no degrees of freedom left or another number of kinds.
  Matrix naive(double cost, Eigen::Index residuals) const;
  Matrix sandwich() const;
  Matrix cr2() const;
  Matrix cr3() const;
  Matrix stratified(const std::vector<std::string>& kinds) const;
  Matrix between_kinds(const std::vector<std::string>& kinds) const;
  double df_cr2(const Vector& c) const;
  double df_cr3(const Vector& c) const;

  // c'CR3 c.
  double cr3_variance(const Vector& c) const;

  // Largest eigenvalue of H^-1/2 H_n H^-1/2: 1 where recording n alone determines something.
  Vector leverages() const;
  // Whether c'q depends on a direction that the data cannot tell (a part above 1e-6 of the scaled c).
  bool undetermined(const Vector& c) const;
  // Share of the variance c'A c that lies where recording n alone determines something (leverage > limit).
  double share_of(std::size_t n, double limit, const Vector& c) const;

  const Matrix& basis() const { return basis_; }                  // B, n x k
  const std::vector<Vector>& scores() const { return g_; }        // B'g_n
  const std::vector<Matrix>& informations() const { return h_; }  // B'H_n B
  Vector whitened(const Vector& c) const { return basis_.transpose() * c; }

 private:
  Matrix from_whitened(const Matrix& middle) const { return basis_ * middle * basis_.transpose(); }
  Matrix power(std::size_t n, double exponent) const;  // (I - H_n)^exponent, whitened
  double satterthwaite(const Vector& c, double exponent) const;

  Matrix basis_, kept_;  // B; orthonormal directions of the scaled space that the data tell
  Vector size_;          // sqrt of the diagonal of H
  std::vector<Vector> g_;
  std::vector<Matrix> h_, directions_;
  std::vector<Vector> values_;  // eigenvalues of h_, ascending, with `directions_`
  std::vector<Matrix> left_;    // (I - H_n)^-1
  Matrix moves_;                // (I - H_n)^-1 g_n, a column per recording
};

// One-way analysis of variance of the scores between kinds of drives, along each eigenvector of H in q.
struct KindTest {
  bool possible = false;  // at least two kinds with at least two recordings
  double f = 0;           // the largest, on (kinds - 1, G - kinds) degrees of freedom
  double p = 1;           // of it
  double df_between = 0, df_within = 0;
  std::vector<double> all_f;  // by eigenvalue of H, largest first
  bool systematic = false;    // p times the number of directions below 1e-6
};
KindTest kind_test(const std::vector<Vector>& g, const std::vector<Matrix>& h,
                   const std::vector<std::string>& kinds);

// Student's t at 97.5 % for df > 0 degrees of freedom.
double t_quantile(double df);

}  // namespace odobench
