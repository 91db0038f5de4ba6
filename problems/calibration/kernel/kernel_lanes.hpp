// Vectors of W numbers, small rotations, and the walk along a segment. For kernel_*.cpp only, like
// kernel_impl.hpp.
#pragma once

#include <math.h>
#include <string.h>

#include "problems/calibration/kernel/kernel.hpp"

namespace odobench::kernel {
namespace {

template <int W>
struct Lanes {
  typedef double Type __attribute__((vector_size(W * sizeof(double))));
};
template <>
struct Lanes<1> {
  typedef double Type;
};
template <int W>
using Pack = typename Lanes<W>::Type;

template <int W>
[[gnu::always_inline]] inline Pack<W> load(const double* from) {
  Pack<W> v;
  memcpy(&v, from, sizeof v);
  return v;
}
template <int W>
[[gnu::always_inline]] inline void store(double* to, const Pack<W>& v) {
  memcpy(to, &v, sizeof v);
}
template <int W>
[[gnu::always_inline]] inline Pack<W> splat(double value) {
  if constexpr (W == 1) {
    return value;
  } else {
    Pack<W> v;
    for (int i = 0; i < W; ++i) v[i] = value;
    return v;
  }
}

// The Taylor series of a small angle, to d^12 and d^11: sin(d) = d + d q s, cos(d) = 1 + q c, q = d^2.
template <int W>
[[gnu::always_inline]] inline void small_angle(const Pack<W>& d, Pack<W>& q, Pack<W>& s, Pack<W>& c) {
  q = d * d;
  s = splat<W>(-1.0 / 39916800.0);
  s = s * q + splat<W>(1.0 / 362880.0);
  s = s * q + splat<W>(-1.0 / 5040.0);
  s = s * q + splat<W>(1.0 / 120.0);
  s = s * q + splat<W>(-1.0 / 6.0);
  c = splat<W>(1.0 / 479001600.0);
  c = c * q + splat<W>(-1.0 / 3628800.0);
  c = c * q + splat<W>(1.0 / 40320.0);
  c = c * q + splat<W>(-1.0 / 720.0);
  c = c * q + splat<W>(1.0 / 24.0);
  c = c * q + splat<W>(-0.5);
}

// (cos - 1, sin) of a small angle: by the series above, or by the library's functions.
template <int W, bool Exact>
[[gnu::always_inline]] inline void rotation(const Pack<W>& d, Pack<W>& cos_minus_one, Pack<W>& sine) {
  if constexpr (Exact && W == 1) {
    sine = ::sin(d);
    const double half = ::sin(0.5 * d);
    cos_minus_one = -2.0 * half * half;
  } else if constexpr (Exact) {
    for (int i = 0; i < W; ++i) {
      sine[i] = ::sin(d[i]);
      const double half = ::sin(0.5 * d[i]);
      cos_minus_one[i] = -2.0 * half * half;
    }
  } else {
    Pack<W> q, s, c;
    small_angle<W>(d, q, s, c);
    sine = d + d * (q * s);
    cos_minus_one = q * c;
  }
}

// Of one step: the heading (c, n) before it, the displacement and the error after it.
template <int W>
struct Step {
  Pack<W> c, n, mx, my, ex, ey;
};

// A segment step by step: heading, position, and the sums of the position's errors.
template <int W>
class Walk {
 public:
  explicit Walk(const CostSums& sums) : c_(load<W>(sums.cos0)), n_(load<W>(sums.sin0)) {}

  // Moves by (ux, uy) in the frame of the heading, then turns. reference: W numbers x, W numbers y.
  template <bool Exact>
  [[gnu::always_inline]] inline Step<W> step(const Pack<W>& ux, const Pack<W>& uy, const Pack<W>& turn,
                                             const double* reference) {
    const Pack<W> c = c_, n = n_, mx = c * ux - n * uy, my = n * ux + c * uy;
    x_ = x_ + mx;
    y_ = y_ + my;
    const Pack<W> dx = x_ - load<W>(reference), dy = y_ - load<W>(reference + W);
    ex_ = ex_ + dx;
    ey_ = ey_ + dy;
    squares_ = squares_ + (dx * dx + dy * dy);
    Pack<W> cm, sn;
    rotation<W, Exact>(turn, cm, sn);
    c_ = c + (c * cm - n * sn);
    n_ = n + (n * cm + c * sn);
    return {c, n, mx, my, dx, dy};
  }
  [[gnu::always_inline]] inline void end(CostSums& sums) const {
    store<W>(sums.x, x_);
    store<W>(sums.y, y_);
    store<W>(sums.ex, ex_);
    store<W>(sums.ey, ey_);
    store<W>(sums.squares, squares_);
  }

 private:
  Pack<W> c_, n_;
  Pack<W> x_ = splat<W>(0), y_ = x_, ex_ = x_, ey_ = x_, squares_ = x_;
};

}  // namespace
}  // namespace odobench::kernel
