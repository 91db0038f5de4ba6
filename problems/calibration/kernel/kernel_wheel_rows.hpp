// The equations of a table of wheels at one step, and their derivatives; for kernel_wheels.hpp only.
#pragma once

#include "problems/calibration/kernel/kernel_lanes.hpp"
#include "problems/calibration/kernel/wheels.hpp"

namespace odobench::kernel {
namespace {

// A wheel at one step, as in problems/robots/wheel_rows.hpp.
template <int W>
struct WheelStep {
  Pack<W> ex, ey, px, py, ax, ay;
  Pack<W> drive, change;            // rad, change times gain
  Pack<W> drive_right, side_right;  // right sides of its rows
  Pack<W> drive_third, side_third;  // p x a, p x n
  Pack<W> drive_left, side_left;    // what the twist leaves of them
};

template <int W>
[[gnu::always_inline]] inline Pack<W> stream(const double* row, int index) {
  return index < 0 ? splat<W>(0) : load<W>(row + index * W);
}

template <int W>
[[gnu::always_inline]] inline void read_wheel(const ModelWheel& w, const double* row, double factor,
                                              WheelStep<W>& s) {
  const Pack<W> c = w.cosine < 0 ? splat<W>(w.cosine_fixed) : load<W>(row + w.cosine * W);
  const Pack<W> n = w.sine < 0 ? splat<W>(w.sine_fixed) : load<W>(row + w.sine * W);
  s.ex = c * w.cos_zero - n * w.sin_zero;
  s.ey = n * w.cos_zero + c * w.sin_zero;
  s.px = w.x + w.trail * s.ex - w.offset * s.ey;
  s.py = w.y + w.trail * s.ey + w.offset * s.ex;
  s.ax = s.ex - w.tangent * s.ey;
  s.ay = s.ey + w.tangent * s.ex;
  s.drive = stream<W>(row, w.drive) * factor;
  s.change = stream<W>(row, w.change) * w.gain;
  s.drive_right = w.radius * s.drive - (w.tangent * w.trail - w.offset) * s.change;
  s.side_right = -w.trail * s.change;
  s.drive_third = s.px * s.ay - s.py * s.ax;
  s.side_third = s.px * s.ex + s.py * s.ey;
}

// The normal matrix of the rows, factored (L D L').
template <int W>
struct Factor3 {
  using V = Pack<W>;
  V i0, l10, l20, i1, l21, i2;
  [[gnu::always_inline]] inline void solve(const V* b, V* x) const {
    const V y1 = b[1] - l10 * b[0], y2 = b[2] - l20 * b[0] - l21 * y1;
    x[2] = y2 * i2;
    x[1] = y1 * i1 - l21 * x[2];
    x[0] = b[0] * i0 - l10 * x[1] - l20 * x[2];
  }
};

template <int W>
[[gnu::always_inline]] inline void factor_rows(const ModelTask& task, const WheelStep<W>* wheels,
                                               Factor3<W>& f, Pack<W>* h) {
  using V = Pack<W>;
  const V zero = splat<W>(0), one = splat<W>(1);
  V n00 = zero, n10 = zero, n20 = zero, n11 = zero, n21 = zero, n22 = zero;
  h[0] = h[1] = h[2] = zero;
  for (int i = 0; i < task.wheel_count; ++i) {
    const WheelStep<W>& s = wheels[i];
    if (task.wheels[i].driven) {
      n00 = n00 + s.ax * s.ax;
      n10 = n10 + s.ay * s.ax;
      n20 = n20 + s.drive_third * s.ax;
      n11 = n11 + s.ay * s.ay;
      n21 = n21 + s.drive_third * s.ay;
      n22 = n22 + s.drive_third * s.drive_third;
      h[0] = h[0] + s.drive_right * s.ax;
      h[1] = h[1] + s.drive_right * s.ay;
      h[2] = h[2] + s.drive_right * s.drive_third;
    }
    if (!task.wheels[i].slides) {
      n00 = n00 + s.ey * s.ey;
      n10 = n10 - s.ex * s.ey;
      n20 = n20 - s.side_third * s.ey;
      n11 = n11 + s.ex * s.ex;
      n21 = n21 + s.side_third * s.ex;
      n22 = n22 + s.side_third * s.side_third;
      h[0] = h[0] - s.side_right * s.ey;
      h[1] = h[1] + s.side_right * s.ex;
      h[2] = h[2] + s.side_right * s.side_third;
    }
  }
  f.i0 = one / n00;
  f.l10 = n10 * f.i0;
  f.l20 = n20 * f.i0;
  f.i1 = one / (n11 - f.l10 * n10);
  const V m21 = n21 - f.l20 * n10;
  f.l21 = m21 * f.i1;
  f.i2 = one / (n22 - f.l20 * n20 - f.l21 * m21);
}

template <int W>
[[gnu::always_inline]] inline void mean_twist(const ModelTask& task, const WheelStep<W>* wheels, Pack<W>* t) {
  t[0] = t[1] = t[2] = splat<W>(0);
  for (int i = 0; i < task.wheel_count; ++i) {
    const WheelStep<W>& s = wheels[i];
    t[0] = t[0] + s.drive_right * s.ex;
    t[1] = t[1] + s.drive_right * s.ey;
    t[2] = t[2] + s.drive_right * (s.px * s.ey - s.py * s.ex) / (s.px * s.px + s.py * s.py);
  }
  const double share = 1.0 / task.wheel_count;
  for (int k = 0; k < 3; ++k) t[k] = t[k] * share;
}

// Derivatives of a wheel's two rows, (a0, a1, a2) of the drive and (s0, s1, s2) of the side, and of their
// right sides b and c. `whole`: not of the third column alone.
template <int W>
struct RowChange {
  Pack<W> a0 = splat<W>(0), a1 = a0, a2 = a0, s0 = a0, s1 = a0, s2 = a0, b = a0, c = a0;
  bool whole = false;
};

// By the heading, times `by`.
template <int W>
[[gnu::always_inline]] inline void heading_change(const ModelWheel& w, const WheelStep<W>& s,
                                                  const Pack<W>& by, RowChange<W>& d) {
  using V = Pack<W>;
  const V nx = -s.ey, ny = s.ex;
  const V ax = nx - w.tangent * s.ex, ay = ny - w.tangent * s.ey;
  const V px = w.trail * nx - w.offset * s.ex, py = w.trail * ny - w.offset * s.ey;
  d.whole = true;
  d.a0 = by * ax;
  d.a1 = by * ay;
  d.a2 = by * (px * s.ay - py * s.ax + s.px * ay - s.py * ax);
  d.s0 = -by * s.ex;
  d.s1 = -by * s.ey;
  d.s2 = by * (px * ny - py * nx - s.px * s.ey + s.py * s.ex);
}

template <int W>
[[gnu::always_inline]] inline void row_change(const ModelWheel& w, const WheelStep<W>& s, const double* row,
                                              ModelField field, RowChange<W>& d) {
  switch (field) {
    case ModelField::X:
      d.a2 = s.ay;
      d.s2 = s.ex;
      break;
    case ModelField::Y:
      d.a2 = -s.ax;
      d.s2 = s.ey;
      break;
    case ModelField::Heading:
      heading_change<W>(w, s, splat<W>(1), d);
      break;
    case ModelField::Gain:
      heading_change<W>(w, s, stream<W>(row, w.steering), d);
      d.b = -(w.tangent * w.trail - w.offset) * stream<W>(row, w.change);
      d.c = -w.trail * stream<W>(row, w.change);
      break;
    case ModelField::Radius:
      d.b = s.drive;
      break;
    case ModelField::Roller: {
      const double slope = 1 + w.tangent * w.tangent;
      d.whole = true;
      d.a0 = -slope * s.ey;
      d.a1 = slope * s.ex;
      d.a2 = slope * s.side_third;
      d.b = -slope * w.trail * s.change;
      break;
    }
    case ModelField::Offset:
      d.a2 = splat<W>(-1);
      d.b = s.change;
      break;
    case ModelField::Trail:
      d.a2 = splat<W>(w.tangent);
      d.b = -w.tangent * s.change;
      d.s2 = splat<W>(1);
      d.c = -s.change;
      break;
  }
}

// d twist / d field at one step.
template <int W>
[[gnu::always_inline]] inline void least_squares_by(const ModelWheel& w, const WheelStep<W>& s,
                                                    const double* row, ModelField field, const Pack<W>* t,
                                                    const Factor3<W>& f, Pack<W>* out) {
  using V = Pack<W>;
  RowChange<W> d;
  row_change<W>(w, s, row, field, d);
  V g[3] = {splat<W>(0), splat<W>(0), splat<W>(0)};
  if (w.driven) {
    V left = d.b - d.a2 * t[2];
    if (d.whole) left = left - d.a0 * t[0] - d.a1 * t[1];
    g[0] = left * s.ax;
    g[1] = left * s.ay;
    g[2] = left * s.drive_third + d.a2 * s.drive_left;
    if (d.whole) {
      g[0] = g[0] + d.a0 * s.drive_left;
      g[1] = g[1] + d.a1 * s.drive_left;
    }
  }
  if (!w.slides) {
    V left = d.c - d.s2 * t[2];
    if (d.whole) left = left - d.s0 * t[0] - d.s1 * t[1];
    g[0] = g[0] - left * s.ey;
    g[1] = g[1] + left * s.ex;
    g[2] = g[2] + left * s.side_third + d.s2 * s.side_left;
    if (d.whole) {
      g[0] = g[0] + d.s0 * s.side_left;
      g[1] = g[1] + d.s1 * s.side_left;
    }
  }
  f.solve(g, out);
}

// By changes of the rows' right sides.
template <int W>
[[gnu::always_inline]] inline void least_squares_right(const ModelWheel& w, const WheelStep<W>& s,
                                                       const Pack<W>& db, const Pack<W>& dc,
                                                       const Factor3<W>& f, Pack<W>* out) {
  using V = Pack<W>;
  V g[3] = {splat<W>(0), splat<W>(0), splat<W>(0)};
  if (w.driven) {
    g[0] = db * s.ax;
    g[1] = db * s.ay;
    g[2] = db * s.drive_third;
  }
  if (!w.slides) {
    g[0] = g[0] - dc * s.ey;
    g[1] = g[1] + dc * s.ex;
    g[2] = g[2] + dc * s.side_third;
  }
  f.solve(g, out);
}

// Of the mean, by v, by the heading phi and by the contact p.
template <int W>
[[gnu::always_inline]] inline void mean_by(const ModelWheel& w, const WheelStep<W>& s, double share,
                                           const Pack<W>& dv, const Pack<W>& dphi, Pack<W> dpx, Pack<W> dpy,
                                           Pack<W>* out) {
  using V = Pack<W>;
  dpx = dpx + dphi * (-w.trail * s.ey - w.offset * s.ex);
  dpy = dpy + dphi * (w.trail * s.ex - w.offset * s.ey);
  const V dex = -dphi * s.ey, dey = dphi * s.ex, v = s.drive_right;
  const V inverse = 1.0 / (s.px * s.px + s.py * s.py), cross = s.px * s.ey - s.py * s.ex;
  const V d_cross = dpx * s.ey - dpy * s.ex + s.px * dey - s.py * dex;
  const V d_squared = 2.0 * (s.px * dpx + s.py * dpy);
  out[0] = share * (dv * s.ex + v * dex);
  out[1] = share * (dv * s.ey + v * dey);
  out[2] = share * inverse * (dv * cross + v * (d_cross - cross * d_squared * inverse));
}

template <int W>
[[gnu::always_inline]] inline void mean_field(const ModelWheel& w, const WheelStep<W>& s, const double* row,
                                              ModelField field, double share, Pack<W>* out) {
  using V = Pack<W>;
  const V zero = splat<W>(0), one = splat<W>(1);
  V dv = zero, dphi = zero, dpx = zero, dpy = zero;
  switch (field) {
    case ModelField::X:
      dpx = one;
      break;
    case ModelField::Y:
      dpy = one;
      break;
    case ModelField::Heading:
      dphi = one;
      break;
    case ModelField::Gain:
      dphi = stream<W>(row, w.steering);
      dv = w.offset * stream<W>(row, w.change);
      break;
    case ModelField::Radius:
      dv = s.drive;
      break;
    case ModelField::Offset:
      dv = s.change;
      dpx = -s.ey;
      dpy = s.ex;
      break;
    case ModelField::Trail:
      dpx = s.ex;
      dpy = s.ey;
      break;
    case ModelField::Roller:
      break;  // the mean has none
  }
  mean_by<W>(w, s, share, dv, dphi, dpx, dpy, out);
}

template <int W>
[[gnu::always_inline]] inline void add_scaled(Pack<W>* to, const Pack<W>* d, double factor) {
  for (int k = 0; k < 3; ++k) to[k] = to[k] + factor * d[k];
}

// Derivatives of the motion by all columns, `by` zeroed before.
template <int W>
[[gnu::always_inline]] inline void motion_by(const ModelTask& task, const double* row, const Pack<W>* t,
                                             Pack<W> (*by)[3]) {
  using V = Pack<W>;
  WheelStep<W> wheels[kMostModelWheels];
  for (int i = 0; i < task.wheel_count; ++i) {
    read_wheel<W>(task.wheels[i], row, task.speed_factor, wheels[i]);
    WheelStep<W>& s = wheels[i];
    s.drive_left = s.drive_right - s.ax * t[0] - s.ay * t[1] - s.drive_third * t[2];
    s.side_left = s.side_right + s.ey * t[0] - s.ex * t[1] - s.side_third * t[2];
  }
  const double share = 1.0 / task.wheel_count;
  Factor3<W> f;
  V h[3];
  if (!task.mean) factor_rows<W>(task, wheels, f, h);
  for (int i = 0; i < task.slot_count; ++i) {
    const ModelSlot& slot = task.slots[i];
    const ModelWheel& w = task.wheels[slot.wheel];
    V d[3];
    if (task.mean)
      mean_field<W>(w, wheels[slot.wheel], row, slot.field, share, d);
    else
      least_squares_by<W>(w, wheels[slot.wheel], row, slot.field, t, f, d);
    for (int k = 0; k < slot.count; ++k) add_scaled<W>(by[slot.terms[k].column], d, slot.terms[k].factor);
  }
  for (int i = 0; i < task.wheel_count; ++i) {
    const ModelWheel& w = task.wheels[i];
    const WheelStep<W>& s = wheels[i];
    const V zero = splat<W>(0);
    V d[3];
    if (task.factor_column >= 0 && w.driven) {
      const V db = w.radius * stream<W>(row, w.drive);
      if (task.mean)
        mean_by<W>(w, s, share, db, zero, zero, zero, d);
      else
        least_squares_right<W>(w, s, db, zero, f, d);
      add_scaled<W>(by[task.factor_column], d, 1);
    }
    if (task.time_column < 0) continue;
    const V turn = w.gain * stream<W>(row, w.steering_by), change = w.gain * stream<W>(row, w.change_by);
    const V db = (w.radius * task.speed_factor) * stream<W>(row, w.drive_by) -
                 (w.tangent * w.trail - w.offset) * change;
    if (task.mean) {
      mean_by<W>(w, s, share, db, turn, zero, zero, d);
      add_scaled<W>(by[task.time_column], d, 1);
      continue;
    }
    least_squares_right<W>(w, s, db, -w.trail * change, f, d);
    add_scaled<W>(by[task.time_column], d, 1);
    if (w.steering_by < 0) continue;
    least_squares_by<W>(w, s, row, ModelField::Heading, t, f, d);
    for (int k = 0; k < 3; ++k) by[task.time_column][k] = by[task.time_column][k] + turn * d[k];
  }
}

}  // namespace
}  // namespace odobench::kernel
