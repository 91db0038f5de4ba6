// Templates behind kernel.hpp, compiled once per vector width. Included by kernel_*.cpp only. Everything has
// internal linkage and uses no inline function of another header, so that no wide instruction leaks into code
// run elsewhere.
#pragma once

#include "problems/calibration/kernel/kernel_rows.hpp"
#include "problems/calibration/kernel/kernel_streams.hpp"
#include "problems/calibration/kernel/kernel_wheels.hpp"

namespace odobench::kernel {
namespace {

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

// The motion of a step by the block's row, in the frame of the heading.
template <int W>
[[gnu::always_inline]] inline void motion(const Parameters<W>& z, const double* row, Pack<W>& ux, Pack<W>& uy,
                                          Pack<W>& turn) {
  using V = Pack<W>;
  const V c0 = load<W>(row), c1 = load<W>(row + W), c2 = load<W>(row + 2 * W), c3 = load<W>(row + 3 * W);
  const V s0 = load<W>(row + 4 * W), s1 = load<W>(row + 5 * W), s2 = load<W>(row + 6 * W),
          s3 = load<W>(row + 7 * W);
  ux = (z.r[0] * c0 + z.r[1] * c1) + (z.r[2] * c2 + z.r[3] * c3);
  uy = (z.r[0] * s0 + z.r[1] * s1) + (z.r[2] * s2 + z.r[3] * s3);
  turn = ((z.q[0] * s0 + z.q[1] * s1) + (z.q[2] * s2 + z.q[3] * s3)) -
         ((z.p[0] * c0 + z.p[1] * c1) + (z.p[2] * c2 + z.p[3] * c3));
}

template <int W, bool Exact>
void run_cost(const Block& block, const double* s, CostSums& sums) {
  const Parameters<W> z(s);
  Walk<W> walk(sums);
  const double* row = block.data;
  for (long k = 0; k < block.steps; ++k, row += kStreams * W) {
    Pack<W> ux, uy, turn;
    motion<W>(z, row, ux, uy, turn);
    walk.template step<Exact>(ux, uy, turn, row + 8 * W);
  }
  walk.end(sums);
}

// Derivatives by r_i: the world's (C_i, S_i); by P_i and Q_i: the displacement, turned by a quarter, times
// the sums of -C_i and S_i before the step.
template <int W>
[[gnu::always_inline]] inline void linear_rows(const Step<W>* steps, int count, const double* data,
                                               NormalRows<W, kLinear, 2>& rows) {
  using V = Pack<W>;
  for (int i = 0; i < 4; ++i) {
    const double* c = data + i * W;
    rows.template columns<3>(i, 4, steps, count, [&](int k, const Step<W>& t, V* heading, V* x, V* y) {
      const V ci = load<W>(c + k * kStreams * W), si = load<W>(c + k * kStreams * W + 4 * W);
      x[0] = t.c * ci - t.n * si;
      y[0] = t.n * ci + t.c * si;
      x[1] = -(t.my * heading[1]);
      y[1] = t.mx * heading[1];
      x[2] = -(t.my * heading[2]);
      y[2] = t.mx * heading[2];
      heading[1] = heading[1] - ci;
      heading[2] = heading[2] + si;
    });
  }
}

template <int W, bool Exact>
void run_normal(const Block& block, const double* s, NormalSums& sums) {
  using Rows = NormalRows<W, kLinear, 2>;
  const Parameters<W> z(s);
  Walk<W> walk(sums.cost);
  Rows rows(kLinear, sums);
  Step<W> steps[Rows::kSteps];
  const double* row = block.data;
  for (long left = block.steps; left > 0;) {
    const int count = Rows::next(left);
    const double* first = row;
    for (int k = 0; k < count; ++k, row += kStreams * W) {
      Pack<W> ux, uy, turn;
      motion<W>(z, row, ux, uy, turn);
      steps[k] = walk.template step<Exact>(ux, uy, turn, row + 8 * W);
    }
    linear_rows<W>(steps, count, first, rows);
    rows.add(count);
    left -= count;
  }
  walk.end(sums.cost);
  rows.end(sums);
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
  return {W,
          cost_block<W>,
          normal_block<W>,
          cost_block<1>,
          normal_block<1>,
          streams_block<W>,
          streams_block<1>,
          streams_normal_block<W>,
          streams_normal_block<1>};
}

}  // namespace
}  // namespace odobench::kernel
