// Robots whose motions are M s (kernel.hpp, StreamBlock): cost and normal equations. For kernel_*.cpp only.
#pragma once

#include "problems/calibration/kernel/kernel_rows.hpp"

namespace odobench::kernel {
namespace {

// (a, b) of a step's rule, by their series for |d| < kMaxAngle.
template <int W, StepRule Rule>
[[gnu::always_inline]] inline void step_weights(const Pack<W>& d, Pack<W>& a, Pack<W>& b) {
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

// M and the motion M s of a step. Streams: how many, 0: as the block says.
template <int W, int Streams>
class StreamMotion {
 public:
  StreamMotion(const double* m, int streams) : count_(Streams > 0 ? Streams : streams) {
    for (int i = 0; i < count_; ++i) {
      mx_[i] = splat<W>(m[i]);
      my_[i] = splat<W>(m[count_ + i]);
      mt_[i] = splat<W>(m[2 * count_ + i]);
    }
  }
  int count() const { return Streams > 0 ? Streams : count_; }
  [[gnu::always_inline]] inline void operator()(const double* row, Pack<W>& x, Pack<W>& y,
                                                Pack<W>& turn) const {
    const int streams = count();
    const Pack<W> first = load<W>(row);
    x = mx_[0] * first;
    y = my_[0] * first;
    turn = mt_[0] * first;
#pragma GCC unroll 8
    for (int i = 1; i < streams; ++i) {
      const Pack<W> stream = load<W>(row + i * W);
      x = x + mx_[i] * stream;
      y = y + my_[i] * stream;
      turn = turn + mt_[i] * stream;
    }
  }

 private:
  int count_;
  Pack<W> mx_[kMostStreams], my_[kMostStreams], mt_[kMostStreams];
};

template <int W, StepRule Rule, int Streams>
void run_streams(const StreamBlock& block, const double* m, CostSums& sums) {
  using V = Pack<W>;
  const StreamMotion<W, Streams> motion(m, block.streams);
  Walk<W> walk(sums);
  const double* row = block.data;
  for (long k = 0; k < block.steps; ++k, row += (motion.count() + 2) * W) {
    V ux, uy, turn;
    motion(row, ux, uy, turn);
    if constexpr (Rule != StepRule::Euler) {
      V a, b;
      step_weights<W, Rule>(turn, a, b);
      const V ahead = ux * a - uy * b;
      uy = ux * b + uy * a;
      ux = ahead;
    }
    walk.template step<false>(ux, uy, turn, row + motion.count() * W);
  }
  walk.end(sums);
}

// Derivatives of step_weights by d.
template <int W, StepRule Rule>
[[gnu::always_inline]] inline void step_slopes(const Pack<W>& d, const Pack<W>& a, const Pack<W>& b,
                                               Pack<W>& da, Pack<W>& db) {
  if constexpr (Rule == StepRule::Midpoint) {
    da = -0.5 * b;
    db = 0.5 * a;
  } else {
    const Pack<W> q = d * d;
    Pack<W> s = splat<W>(-1.0 / 3991680.0);
    s = s * q + splat<W>(1.0 / 45360.0);
    s = s * q + splat<W>(-1.0 / 840.0);
    s = s * q + splat<W>(1.0 / 30.0);
    da = d * (s * q + splat<W>(-1.0 / 3.0));
    Pack<W> c = splat<W>(-1.0 / 43545600.0);
    c = c * q + splat<W>(1.0 / 403200.0);
    c = c * q + splat<W>(-1.0 / 5760.0);
    c = c * q + splat<W>(1.0 / 144.0);
    c = c * q + splat<W>(-1.0 / 8.0);
    db = c * q + splat<W>(0.5);
  }
}

// Of one step: a derivative changes by (ax, ay) (dux, duy) + (bx, by) dturn, products of complex numbers,
// and by the displacement turned by a quarter times the derivative of the heading.
template <int W>
struct StreamStep {
  Pack<W> ax, ay, bx, by, mx, my, ex, ey;
};

template <int W, StepRule Rule, int Streams>
[[gnu::always_inline]] inline StreamStep<W> stream_step(const StreamMotion<W, Streams>& motion,
                                                        const double* row, Walk<W>& walk) {
  using V = Pack<W>;
  V ux, uy, turn;
  motion(row, ux, uy, turn);
  const double* reference = row + motion.count() * W;
  if constexpr (Rule == StepRule::Euler) {
    const Step<W> t = walk.template step<false>(ux, uy, turn, reference);
    return {t.c, t.n, splat<W>(0), splat<W>(0), t.mx, t.my, t.ex, t.ey};
  } else {
    V a, b, da, db;
    step_weights<W, Rule>(turn, a, b);
    step_slopes<W, Rule>(turn, a, b, da, db);
    const Step<W> t = walk.template step<false>(ux * a - uy * b, ux * b + uy * a, turn, reference);
    const V vx = ux * da - uy * db, vy = ux * db + uy * da;
    return {t.c * a - t.n * b,
            t.n * a + t.c * b,
            t.c * vx - t.n * vy,
            t.n * vx + t.c * vy,
            t.mx,
            t.my,
            t.ex,
            t.ey};
  }
}

template <int W, StepRule Rule, int Streams>
void run_streams_normal(const StreamBlock& block, const double* m, const StreamDerivatives& derivatives,
                        NormalSums& sums) {
  using V = Pack<W>;
  using Rows = NormalRows<W, 0, 1>;
  const StreamMotion<W, Streams> motion(m, block.streams);
  const int columns = derivatives.columns, stride = (motion.count() + 2) * W;
  Walk<W> walk(sums.cost);
  Rows rows(columns, sums);
  StreamStep<W> steps[Rows::kSteps];
  const double* row = block.data;
  for (long left = block.steps; left > 0;) {
    const int count = Rows::next(left);
    const double* first = row;
    for (int k = 0; k < count; ++k, row += stride)
      steps[k] = stream_step<W, Rule, Streams>(motion, row, walk);
    for (int p = 0; p < columns; ++p) {
      const StreamMotion<W, Streams> by(derivatives.by + 3 * p * motion.count(), block.streams);
      rows.template columns<1>(p, 1, steps, count,
                               [&](int k, const StreamStep<W>& t, V* heading, V* x, V* y) {
                                 V ux, uy, turn;
                                 by(first + k * stride, ux, uy, turn);
                                 *x = t.ax * ux - t.ay * uy - t.my * *heading;
                                 *y = t.ay * ux + t.ax * uy + t.mx * *heading;
                                 if constexpr (Rule != StepRule::Euler) {
                                   *x = *x + t.bx * turn;
                                   *y = *y + t.by * turn;
                                 }
                                 *heading = *heading + turn;
                               });
    }
    rows.add(count);
    left -= count;
  }
  walk.end(sums.cost);
  rows.end(sums);
}

template <int W, StepRule Rule, int Streams>
struct StreamRuns {
  static void cost(const StreamBlock& block, const double* m, CostSums& sums) {
    run_streams<W, Rule, Streams>(block, m, sums);
  }
  static void normal(const StreamBlock& block, const double* m, const StreamDerivatives& by,
                     NormalSums& sums) {
    run_streams_normal<W, Rule, Streams>(block, m, by, sums);
  }
};

// Calls run(StreamRuns of the block).
template <int W, StepRule Rule, class Run>
void streams_by_count(const StreamBlock& block, const Run& run) {
  switch (block.streams) {
    case 2:
      return run(StreamRuns<W, Rule, 2>());
    case 3:
      return run(StreamRuns<W, Rule, 3>());
    case 4:
      return run(StreamRuns<W, Rule, 4>());
    case 8:
      return run(StreamRuns<W, Rule, 8>());
    default:
      return run(StreamRuns<W, Rule, 0>());
  }
}

template <int W, class Run>
void streams_by_rule(const StreamBlock& block, const Run& run) {
  switch (block.rule) {
    case StepRule::Euler:
      return streams_by_count<W, StepRule::Euler>(block, run);
    case StepRule::Midpoint:
      return streams_by_count<W, StepRule::Midpoint>(block, run);
    default:
      return streams_by_count<W, StepRule::Arc>(block, run);
  }
}

template <int W>
void streams_block(const StreamBlock& block, const double* m, CostSums& sums) {
  streams_by_rule<W>(block, [&](auto runs) { runs.cost(block, m, sums); });
}

template <int W>
void streams_normal_block(const StreamBlock& block, const double* m, const StreamDerivatives& by,
                          NormalSums& sums) {
  streams_by_rule<W>(block, [&](auto runs) { runs.normal(block, m, by, sums); });
}

}  // namespace
}  // namespace odobench::kernel
