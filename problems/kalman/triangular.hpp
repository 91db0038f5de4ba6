// The one operation behind our square-root filters: from a wide array M with M M' = P to a lower-triangular S
// with S S' = P, by Householder reflections from the right. P itself is never formed, so it cannot lose
// symmetry or get a negative eigenvalue, and S keeps twice the digits of P.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace odobench {

// m is n x k; the result n x n, diagonal >= 0, zeros above it. Columns beyond n may be zero or absent (k <
// n). Equations: G. Golub, C. Van Loan, Matrix Computations, 5.1; row i is reflected onto its diagonal entry.
template <int N, int K>
Eigen::Matrix<double, N, N> lower_triangular(Eigen::Matrix<double, N, K> m) {
  const Eigen::Index n = m.rows(), k = m.cols();
  Eigen::Matrix<double, N, N> s = Eigen::Matrix<double, N, N>::Zero(n, n);
  for (Eigen::Index i = 0; i < n && i < k; ++i) {
    double tail = 0;
    for (Eigen::Index c = i + 1; c < k; ++c) tail += m(i, c) * m(i, c);
    const double head = m(i, i);
    if (tail > 0) {
      const double norm = std::sqrt(head * head + tail);
      // v = (head + sign(head) norm, rest), scaled below by v0; the reflected head is -sign(head) norm.
      const double v0 = head >= 0 ? head + norm : head - norm;
      const double beta = 2 / (v0 * v0 + tail);
      for (Eigen::Index r = i + 1; r < n; ++r) {
        double dot = v0 * m(r, i);
        for (Eigen::Index c = i + 1; c < k; ++c) dot += m(i, c) * m(r, c);
        dot *= beta;
        m(r, i) -= dot * v0;
        for (Eigen::Index c = i + 1; c < k; ++c) m(r, c) -= dot * m(i, c);
      }
      m(i, i) = head >= 0 ? -norm : norm;
    }
    const double sign = m(i, i) < 0 ? -1.0 : 1.0;
    for (Eigen::Index r = i; r < n; ++r) s(r, i) = sign * m(r, i);
  }
  return s;
}

// s s' with both triangles the same bits.
template <int N>
Eigen::Matrix<double, N, N> squared(const Eigen::Matrix<double, N, N>& s) {
  Eigen::Matrix<double, N, N> p(s.rows(), s.cols());
  for (Eigen::Index i = 0; i < s.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      double sum = 0;
      for (Eigen::Index c = 0; c <= j; ++c) sum += s(i, c) * s(j, c);
      p(i, j) = p(j, i) = sum;
    }
  return p;
}

}  // namespace odobench
