// Templates behind kernel.hpp, compiled once per vector width. Included by kernel_*.cpp only. Everything has
// internal linkage and uses no inline function of another header, so that no wide instruction leaks into code
// run elsewhere.
#pragma once

#include <math.h>
#include <string.h>

#include "problems/calibration/kernel.hpp"

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
inline Pack<W> load(const double* from) {
  Pack<W> v;
  memcpy(&v, from, sizeof v);
  return v;
}
template <int W>
inline void store(double* to, const Pack<W>& v) {
  memcpy(to, &v, sizeof v);
}
template <int W>
inline Pack<W> splat(double value) {
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
inline void small_angle(const Pack<W>& d, Pack<W>& q, Pack<W>& s, Pack<W>& c) {
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
inline void rotation(const Pack<W>& d, Pack<W>& cos_minus_one, Pack<W>& sine) {
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

// A segment step by step: heading, position, and the sums of the position's errors.
template <int W>
class Walk {
 public:
  explicit Walk(const CostSums& sums) : c_(load<W>(sums.cos0)), n_(load<W>(sums.sin0)) {}

  // Moves by (ux, uy) in the frame of the heading, then turns. reference: W numbers x, W numbers y.
  template <bool Exact>
  inline void step(const Pack<W>& ux, const Pack<W>& uy, const Pack<W>& turn, const double* reference) {
    x_ = x_ + (c_ * ux - n_ * uy);
    y_ = y_ + (n_ * ux + c_ * uy);
    const Pack<W> dx = x_ - load<W>(reference), dy = y_ - load<W>(reference + W);
    ex_ = ex_ + dx;
    ey_ = ey_ + dy;
    squares_ = squares_ + (dx * dx + dy * dy);
    Pack<W> cm, sn;
    rotation<W, Exact>(turn, cm, sn);
    const Pack<W> next = c_ + (c_ * cm - n_ * sn);
    n_ = n_ + (n_ * cm + c_ * sn);
    c_ = next;
  }
  inline void end(CostSums& sums) const {
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

template <int W>
struct Parameters {
  Pack<W> r[4], p[4], q[4];
  explicit Parameters(const double* s) {
    for (int i = 0; i < 4; ++i) {
      r[i] = splat<W>(s[i]);
      p[i] = splat<W>(s[4 + i]);
      q[i] = splat<W>(s[8 + i]);
    }
  }
};

template <int W, bool Exact>
void run_cost(const Block& block, const double* s, CostSums& sums) {
  using V = Pack<W>;
  const Parameters<W> z(s);
  Walk<W> walk(sums);
  const double* row = block.data;
  for (long k = 0; k < block.steps; ++k, row += kStreams * W) {
    const V c0 = load<W>(row), c1 = load<W>(row + W), c2 = load<W>(row + 2 * W), c3 = load<W>(row + 3 * W);
    const V s0 = load<W>(row + 4 * W), s1 = load<W>(row + 5 * W), s2 = load<W>(row + 6 * W),
            s3 = load<W>(row + 7 * W);
    const V ux = (z.r[0] * c0 + z.r[1] * c1) + (z.r[2] * c2 + z.r[3] * c3);
    const V uy = (z.r[0] * s0 + z.r[1] * s1) + (z.r[2] * s2 + z.r[3] * s3);
    const V turn = ((z.q[0] * s0 + z.q[1] * s1) + (z.q[2] * s2 + z.q[3] * s3)) -
                   ((z.p[0] * c0 + z.p[1] * c1) + (z.p[2] * c2 + z.p[3] * c3));
    walk.template step<Exact>(ux, uy, turn, row + 8 * W);
  }
  walk.end(sums);
}

template <int W, bool Exact>
void run_normal(const Block& block, const double* s, NormalSums& sums) {
  using V = Pack<W>;
  const V zero = splat<W>(0);
  const Parameters<W> z(s);
  V c = load<W>(sums.cost.cos0), n = load<W>(sums.cost.sin0);
  V x = zero, y = zero, ex = zero, ey = zero, squares = zero;
  V heading[kHeading], gx[kLinear], gy[kLinear], sgx[kLinear], sgy[kLinear], jtr[kLinear], jtj[kTriangle];
  for (int j = 0; j < kHeading; ++j) heading[j] = load<W>(sums.heading0[j]);
  for (int j = 0; j < kLinear; ++j) gx[j] = gy[j] = sgx[j] = sgy[j] = jtr[j] = zero;
  for (int j = 0; j < kTriangle; ++j) jtj[j] = zero;
  const double* row = block.data;
  for (long k = 0; k < block.steps; ++k, row += kStreams * W) {
    V ux = zero, uy = zero, turn = zero;
    V ci[4], si[4];
    for (int i = 0; i < 4; ++i) {
      ci[i] = load<W>(row + i * W);
      si[i] = load<W>(row + (4 + i) * W);
      ux = ux + z.r[i] * ci[i];
      uy = uy + z.r[i] * si[i];
      turn = turn + (z.q[i] * si[i] - z.p[i] * ci[i]);
    }
    const V mx = c * ux - n * uy, my = n * ux + c * uy;
    x = x + mx;
    y = y + my;
    for (int i = 0; i < 4; ++i) {
      gx[i] = gx[i] + (c * ci[i] - n * si[i]);
      gy[i] = gy[i] + (n * ci[i] + c * si[i]);
    }
    for (int j = 0; j < kHeading; ++j) {
      gx[4 + j] = gx[4 + j] - my * heading[j];
      gy[4 + j] = gy[4 + j] + mx * heading[j];
    }
    for (int i = 0; i < 4; ++i) {
      heading[i] = heading[i] - ci[i];
      heading[4 + i] = heading[4 + i] + si[i];
    }
    const V dx = x - load<W>(row + 8 * W), dy = y - load<W>(row + 9 * W);
    ex = ex + dx;
    ey = ey + dy;
    squares = squares + (dx * dx + dy * dy);
    int entry = 0;
#pragma GCC unroll 12
    for (int i = 0; i < kLinear; ++i) {
      sgx[i] = sgx[i] + gx[i];
      sgy[i] = sgy[i] + gy[i];
      jtr[i] = jtr[i] + (gx[i] * dx + gy[i] * dy);
#pragma GCC unroll 12
      for (int j = 0; j <= i; ++j, ++entry) jtj[entry] = jtj[entry] + (gx[i] * gx[j] + gy[i] * gy[j]);
    }
    V cm, sn;
    rotation<W, Exact>(turn, cm, sn);
    const V next = c + (c * cm - n * sn);
    n = n + (n * cm + c * sn);
    c = next;
  }
  store<W>(sums.cost.x, x);
  store<W>(sums.cost.y, y);
  store<W>(sums.cost.ex, ex);
  store<W>(sums.cost.ey, ey);
  store<W>(sums.cost.squares, squares);
  for (int j = 0; j < kLinear; ++j) {
    store<W>(sums.gx[j], gx[j]);
    store<W>(sums.gy[j], gy[j]);
    store<W>(sums.sum_gx[j], sgx[j]);
    store<W>(sums.sum_gy[j], sgy[j]);
    store<W>(sums.jtr[j], jtr[j]);
  }
  for (int j = 0; j < kTriangle; ++j) store<W>(sums.jtj[j], jtj[j]);
}

// (a, b) of a step's rule, by their series for |d| < kMaxAngle.
template <int W, StepRule Rule>
inline void step_weights(const Pack<W>& d, Pack<W>& a, Pack<W>& b) {
  if constexpr (Rule == StepRule::Midpoint) {
    rotation<W, false>(0.5 * d, a, b);
    a = a + splat<W>(1.0);
  } else {
    Pack<W> q, s, c;
    small_angle<W>(d, q, s, c);
    a = splat<W>(1.0) + q * s;
    b = -(d * c);
  }
}

// Streams: how many, 0: as the block says.
template <int W, StepRule Rule, int Streams>
void run_streams(const StreamBlock& block, const double* m, CostSums& sums) {
  using V = Pack<W>;
  const int count = Streams > 0 ? Streams : block.streams;
  V mx[kMostStreams], my[kMostStreams], mt[kMostStreams];
  for (int i = 0; i < count; ++i) {
    mx[i] = splat<W>(m[i]);
    my[i] = splat<W>(m[count + i]);
    mt[i] = splat<W>(m[2 * count + i]);
  }
  Walk<W> walk(sums);
  const double* row = block.data;
  for (long k = 0; k < block.steps; ++k, row += (count + 2) * W) {
    const V first = load<W>(row);
    V ux = mx[0] * first, uy = my[0] * first, turn = mt[0] * first;
#pragma GCC unroll 8
    for (int i = 1; i < count; ++i) {
      const V stream = load<W>(row + i * W);
      ux = ux + mx[i] * stream;
      uy = uy + my[i] * stream;
      turn = turn + mt[i] * stream;
    }
    if constexpr (Rule != StepRule::Euler) {
      V a, b;
      step_weights<W, Rule>(turn, a, b);
      const V ahead = ux * a - uy * b;
      uy = ux * b + uy * a;
      ux = ahead;
    }
    walk.template step<false>(ux, uy, turn, row + count * W);
  }
  walk.end(sums);
}

template <int W, StepRule Rule>
void streams_by_count(const StreamBlock& block, const double* m, CostSums& sums) {
  switch (block.streams) {
    case 2:
      return run_streams<W, Rule, 2>(block, m, sums);
    case 3:
      return run_streams<W, Rule, 3>(block, m, sums);
    case 4:
      return run_streams<W, Rule, 4>(block, m, sums);
    default:
      return run_streams<W, Rule, 0>(block, m, sums);
  }
}

template <int W>
void streams_block(const StreamBlock& block, const double* m, CostSums& sums) {
  switch (block.rule) {
    case StepRule::Euler:
      return streams_by_count<W, StepRule::Euler>(block, m, sums);
    case StepRule::Midpoint:
      return streams_by_count<W, StepRule::Midpoint>(block, m, sums);
    default:
      return streams_by_count<W, StepRule::Arc>(block, m, sums);
  }
}

template <int W>
void cost_block(const Block& block, const double* s, bool exact, CostSums& sums) {
  exact ? run_cost<W, true>(block, s, sums) : run_cost<W, false>(block, s, sums);
}

template <int W>
void normal_block(const Block& block, const double* s, bool exact, NormalSums& sums) {
  exact ? run_normal<W, true>(block, s, sums) : run_normal<W, false>(block, s, sums);
}

template <int W>
constexpr Kernel make_kernel() {
  return {
      W, cost_block<W>, normal_block<W>, cost_block<1>, normal_block<1>, streams_block<W>, streams_block<1>};
}

}  // namespace
}  // namespace odobench::kernel
