// Templates behind wheels.hpp; for kernel_impl.hpp only.
#pragma once

#include "problems/calibration/kernel/kernel_wheel_rows.hpp"
#include "problems/calibration/kernel/wheels.hpp"

namespace odobench::kernel {
namespace {

// sin(h) / h and its derivative.
template <int W, bool Exact>
[[gnu::always_inline]] inline void quotient(const Pack<W>& h, Pack<W>& f, Pack<W>& slope) {
  const Pack<W> q = h * h;
  f = 1.0 + q * (-1.0 / 6 + q * (1.0 / 120 + q * (-1.0 / 5040 + q * (1.0 / 362880 - q / 39916800.0))));
  slope =
      h * (-1.0 / 3 +
           q * (1.0 / 30 + q * (-1.0 / 840 + q * (1.0 / 45360 + q * (-1.0 / 3991680 + q / 518918400.0)))));
  if constexpr (Exact) {
    const auto by_library = [](double x, double& value, double& by) {
      if (x * x < 0.09) return;
      value = ::sin(x) / x;
      by = (::cos(x) - value) / x;
    };
    if constexpr (W == 1) {
      by_library(h, f, slope);
    } else {
      for (int i = 0; i < W; ++i) {
        double value = f[i], by = slope[i];
        by_library(h[i], value, by);
        f[i] = value;
        slope[i] = by;
      }
    }
  }
}

// The displacement of a step: factor and heading, from the heading (c, n) before it.
template <int W>
struct Displacement {
  Pack<W> c, n, f, slope, mx, my;
};

template <int W, bool Exact>
[[gnu::always_inline]] inline void displace(StepRule rule, const Pack<W>& c, const Pack<W>& n,
                                            const Pack<W>* u, Displacement<W>& d) {
  d.c = c;
  d.n = n;
  d.f = splat<W>(1);
  d.slope = splat<W>(0);
  if (rule != StepRule::Euler) {
    const Pack<W> h = 0.5 * u[2];
    Pack<W> cm, sn;
    rotation<W, Exact>(h, cm, sn);
    d.c = c + (c * cm - n * sn);
    d.n = n + (n * cm + c * sn);
    if (rule == StepRule::Arc) quotient<W, Exact>(h, d.f, d.slope);
  }
  d.mx = d.f * (d.c * u[0] - d.n * u[1]);
  d.my = d.f * (d.n * u[0] + d.c * u[1]);
}

template <int W, bool Exact>
void walk_wheels(const ModelTask& task, double* walk) {
  using V = Pack<W>;
  V c = splat<W>(1), n = splat<W>(0), x = n, y = n, heading = n;
  const double* row = task.data;
  for (long k = 0; k < task.steps; ++k, row += task.streams * W, walk += kWalk * W) {
    WheelStep<W> wheels[kMostModelWheels];
    for (int i = 0; i < task.wheel_count; ++i)
      read_wheel<W>(task.wheels[i], row, task.speed_factor, wheels[i]);
    V u[3];
    if (task.mean) {
      mean_twist<W>(task, wheels, u);
    } else {
      Factor3<W> f;
      V h[3];
      factor_rows<W>(task, wheels, f, h);
      f.solve(h, u);
    }
    Displacement<W> d;
    displace<W, Exact>(task.rule, c, n, u, d);
    x = x + d.mx;
    y = y + d.my;
    heading = heading + u[2];
    V cm, sn;
    rotation<W, Exact>(u[2], cm, sn);
    const V before = c;
    c = c + (c * cm - n * sn);
    n = n + (n * cm + before * sn);
    const V all[kWalk] = {u[0], u[1], u[2], c, n, x, y, heading};
    for (int e = 0; e < kWalk; ++e) store<W>(walk + e * W, all[e]);
  }
}

// Rows of a few steps, gathered so that the sums of products are loaded and stored once for all of them.
inline constexpr int kGathered = 4;

template <int W>
struct GatheredRows {
  Pack<W> x[kMostModelColumns][kGathered], y[kMostModelColumns][kGathered], t[kMostModelColumns][kGathered];
  // Adds the products; `w`: weight of headings.
  [[gnu::always_inline]] inline void add(int columns, double w, double* triangle_sums) const {
    double* to = triangle_sums;
    for (int i = 0; i < columns; ++i) {
      Pack<W> turned[kGathered];
      for (int k = 0; k < kGathered; ++k) turned[k] = w * t[i][k];
      for (int j = 0; j <= i; ++j, to += W) {
        Pack<W> sum = load<W>(to);
        for (int k = 0; k < kGathered; ++k)
          sum = sum + (x[i][k] * x[j][k] + y[i][k] * y[j][k] + turned[k] * t[j][k]);
        store<W>(to, sum);
      }
    }
  }
};

// The derivatives (X, Y, T) of the pose by all columns, carried from step to step.
template <int W>
struct CarriedColumns {
  Pack<W> at[kMostModelColumns][3];

  template <bool Exact>
  [[gnu::always_inline]] inline void step(const ModelTask& task, const double* row, const Pack<W>* u,
                                          const Pack<W>& c, const Pack<W>& n) {
    using V = Pack<W>;
    V by[kMostModelColumns][3];
    for (int j = 0; j < task.columns; ++j) by[j][0] = by[j][1] = by[j][2] = splat<W>(0);
    motion_by<W>(task, row, u, by);
    Displacement<W> d;
    displace<W, Exact>(task.rule, c, n, u, d);
    const V fc = d.f * d.c, fn = d.f * d.n;
    if (task.rule == StepRule::Euler) {
      for (int j = 0; j < task.columns; ++j) {
        const V turned = at[j][2];
        at[j][0] = at[j][0] + (fc * by[j][0] - fn * by[j][1] - d.my * turned);
        at[j][1] = at[j][1] + (fn * by[j][0] + fc * by[j][1] + d.mx * turned);
        at[j][2] = turned + by[j][2];
      }
      return;
    }
    const V sx = d.slope * (d.c * u[0] - d.n * u[1]), sy = d.slope * (d.n * u[0] + d.c * u[1]);
    for (int j = 0; j < task.columns; ++j) {
      const V dh = 0.5 * by[j][2], turned = at[j][2] + dh;
      at[j][0] = at[j][0] + (fc * by[j][0] - fn * by[j][1] + sx * dh - d.my * turned);
      at[j][1] = at[j][1] + (fn * by[j][0] + fc * by[j][1] + sy * dh + d.mx * turned);
      at[j][2] = at[j][2] + by[j][2];
    }
  }
  // Of the tracked frame, after a step to the heading (c, n).
  [[gnu::always_inline]] inline void row(const ModelTask& task, int j, const Pack<W>& c, const Pack<W>& n,
                                         Pack<W>* out) const {
    if (j == task.lever_x_column || j == task.lever_y_column) {
      out[0] = j == task.lever_x_column ? c : -n;
      out[1] = j == task.lever_x_column ? n : c;
      out[2] = splat<W>(0);
      return;
    }
    if (j == task.yaw_column) {
      out[0] = out[1] = splat<W>(0);
      out[2] = splat<W>(1);
      return;
    }
    out[0] = at[j][0] - at[j][2] * (n * task.lever_x + c * task.lever_y);
    out[1] = at[j][1] + at[j][2] * (c * task.lever_x - n * task.lever_y);
    out[2] = at[j][2];
  }
  [[gnu::always_inline]] inline void end(int columns, double* sums) const {
    for (int j = 0; j < columns; ++j)
      for (int k = 0; k < 3; ++k) store<W>(sums + (j * kColumnSums + 6 + k) * W, at[j][k]);
  }
};

template <int W, bool Exact>
void columns_of_wheels(const ModelTask& task, const double* walk, const double* errors, double* sums) {
  using V = Pack<W>;
  CarriedColumns<W> carried;
  GatheredRows<W> gathered;
  V column_sums[kMostModelColumns][6];
  const int columns = task.columns;
  for (int j = 0; j < columns; ++j) {
    for (int k = 0; k < 3; ++k) carried.at[j][k] = splat<W>(0);
    for (int k = 0; k < 6; ++k) column_sums[j][k] = splat<W>(0);
  }
  double* products = sums + columns * kColumnSums * W;
  for (int e = 0; e < triangle(columns) * W; ++e) products[e] = 0;
  V c = splat<W>(1), n = splat<W>(0);
  const double* row = task.data;
  int held = 0;
  for (long k = 0; k < task.steps; ++k) {
    const V u[3] = {load<W>(walk), load<W>(walk + W), load<W>(walk + 2 * W)};
    carried.template step<Exact>(task, row, u, c, n);
    c = load<W>(walk + kCos * W);
    n = load<W>(walk + kSin * W);
    const V px = load<W>(walk + kX * W) + (c * task.lever_x - n * task.lever_y),
            py = load<W>(walk + kY * W) + (n * task.lever_x + c * task.lever_y);
    const V ex = load<W>(errors), ey = load<W>(errors + W),
            et = load<W>(errors + 2 * W) * task.heading_weight, counts = load<W>(errors + 3 * W);
    for (int j = 0; j < columns; ++j) {
      V r[3];
      carried.row(task, j, c, n, r);
      const V x = r[0] * counts, y = r[1] * counts, t = r[2] * counts;
      gathered.x[j][held] = x;
      gathered.y[j][held] = y;
      gathered.t[j][held] = t;
      V* s = column_sums[j];
      s[0] = s[0] + (x * ex + y * ey + t * et);
      s[1] = s[1] + x;
      s[2] = s[2] + y;
      s[3] = s[3] + t;
      s[4] = s[4] + (y * px - x * py);
      s[5] = s[5] + (x * ey - y * ex);
    }
    if (++held == kGathered || k + 1 == task.steps) {
      for (; held < kGathered; ++held)
        for (int j = 0; j < columns; ++j)
          gathered.x[j][held] = gathered.y[j][held] = gathered.t[j][held] = splat<W>(0);
      gathered.add(columns, task.heading_weight, products);
      held = 0;
    }
    row += task.streams * W;
    walk += kWalk * W;
    errors += kErrors * W;
  }
  for (int j = 0; j < columns; ++j)
    for (int k = 0; k < 6; ++k) store<W>(sums + (j * kColumnSums + k) * W, column_sums[j][k]);
  carried.end(columns, sums);
}

template <int W, bool Exact>
void rows_of_wheels(const ModelTask& task, const double* walk, double* rows, double* sums) {
  using V = Pack<W>;
  CarriedColumns<W> carried;
  for (int j = 0; j < task.columns; ++j)
    for (int k = 0; k < 3; ++k) carried.at[j][k] = splat<W>(0);
  V c = splat<W>(1), n = splat<W>(0);
  const double* row = task.data;
  for (long k = 0; k < task.steps; ++k, row += task.streams * W, walk += kWalk * W) {
    const V u[3] = {load<W>(walk), load<W>(walk + W), load<W>(walk + 2 * W)};
    carried.template step<Exact>(task, row, u, c, n);
    c = load<W>(walk + kCos * W);
    n = load<W>(walk + kSin * W);
    for (int j = 0; j < task.columns; ++j, rows += 3 * W) {
      V r[3];
      carried.row(task, j, c, n, r);
      for (int e = 0; e < 3; ++e) store<W>(rows + e * W, r[e]);
    }
  }
  carried.end(task.columns, sums);
}

template <int W>
void walk_block(const ModelTask& task, double* walk) {
  task.exact ? walk_wheels<W, true>(task, walk) : walk_wheels<W, false>(task, walk);
}
template <int W>
void columns_block(const ModelTask& task, const double* walk, const double* errors, double* sums) {
  task.exact ? columns_of_wheels<W, true>(task, walk, errors, sums)
             : columns_of_wheels<W, false>(task, walk, errors, sums);
}
template <int W>
void rows_block(const ModelTask& task, const double* walk, double* rows, double* sums) {
  task.exact ? rows_of_wheels<W, true>(task, walk, rows, sums)
             : rows_of_wheels<W, false>(task, walk, rows, sums);
}

template <int W>
constexpr ModelKernel make_model_kernel() {
  return {W, walk_block<W>, columns_block<W>, rows_block<W>};
}

}  // namespace
}  // namespace odobench::kernel
