// The statistics that findings are made of: pure functions of numbers, O(n).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "problems/matrices.hpp"

namespace odobench::inspection {

using Eigen::Index;

// D[f]_k: slope of the least-squares line through f over t at the samples k-h ... k+h, clipped at the ends,
//     sum (t - tm) f / sum (t - tm)^2,   tm: mean of t there,
// by sums from the first sample on. t strictly increasing, s; at least two samples; h >= 1.
class LocalLine {
 public:
  LocalLine() = default;
  LocalLine(const Vector& t, Index h);
  // f as long as t; the result is f's unit per second.
  Vector slope(const ConstVectorRef& f) const;
  Index half() const { return half_; }

 private:
  Index half_ = 1;
  Vector time_, mean_, inverse_;  // from the mean stamp; of each window: mean of it, 1 / sum of squares
};

// The value below which `share` (0 to 1) of the entries lie: of the sorted ones that at index
// floor(share (n - 1) + 0.5). 0 of none. Not-a-numbers are
// left out. Entries are reordered.
double percentile(std::vector<double>& values, double share);
double median(std::vector<double>& values);

// |v_k - median of v_{k-3} ... v_{k+3}|, the window clipped at the ends.
Vector off_median(const Vector& v);
// The median of the (up to) seven values around k.
double median_of_seven(const Vector& v, Index k);

// A stretch of equal entries, or of entries for which something holds: samples first ... last.
struct Stretch {
  Index first = 0, last = 0;
  Index size() const { return last - first + 1; }
};
// All stretches of at least `least` samples at which `holds` is true.
std::vector<Stretch> stretches(const std::vector<char>& holds, Index least);

// The lag of `late` behind `early`, both 3 x n on one grid of step T [s]: the normalised cross-correlation
//     C(L) = sum (e_k - em)(l_{k+L} - lm) / sqrt(sum (e_k - em)^2 sum (l_{k+L} - lm)^2)
// of the three rows together, means of the overlap removed row by row, for |L| <= most; its peak by the
// parabola through three points. sd = sqrt((1 - C^2) / (n_eff c)), n_eff = n / window, c = -C'' at the peak,
// 1/s^2. Where `late` is late, lag > 0.
struct Lag {
  double seconds = 0, deviation = 0, correlation = 0;
  bool usable = false;  // C > 0.8, and not at an end
};
Lag lag_of(const Matrix& early, const Matrix& late, double step, Index most, double window);

}  // namespace odobench::inspection
