// J'J, J'r and the sums of derivatives, from the rows of a few steps at a time: one update of a tile of J'J
// in registers for all of them. For kernel_*.cpp only.
#pragma once

#include "problems/calibration/kernel/kernel_lanes.hpp"

namespace odobench::kernel {
namespace {

inline constexpr int kBlockRows = 8;
// Rows and columns of a tile: its entries, a row of it and a column's number must fit into the registers.
template <int W>
inline constexpr int kTile = W == 8 ? 4 : 3;

// entries(i, j) += sum over rows of row[i] row[j], for i = first .. first + Height - 1 and j = begin ..
// begin + Length - 1, where Diagonal only j <= i. Rows are `stride` numbers apart.
template <int W, int Height, int Length, bool Diagonal>
void add_tile(const double* rows, int count, int stride, int first, int begin, double* entries) {
  using V = Pack<W>;
  V sum[Height][Length];
#pragma GCC unroll 4
  for (int i = 0; i < Height; ++i)
#pragma GCC unroll 4
    for (int j = 0; j < (Diagonal ? i + 1 : Length); ++j)
      sum[i][j] = load<W>(entries + (triangle(first + i) + begin + j) * W);
  for (int k = 0; k < count; ++k, rows += stride) {
    V left[Height];
#pragma GCC unroll 4
    for (int i = 0; i < Height; ++i) left[i] = load<W>(rows + (first + i) * W);
#pragma GCC unroll 4
    for (int j = 0; j < Length; ++j) {
      const V right = Diagonal ? left[j] : load<W>(rows + (begin + j) * W);
#pragma GCC unroll 4
      for (int i = Diagonal ? j : 0; i < Height; ++i) sum[i][j] = sum[i][j] + left[i] * right;
    }
  }
#pragma GCC unroll 4
  for (int i = 0; i < Height; ++i)
#pragma GCC unroll 4
    for (int j = 0; j < (Diagonal ? i + 1 : Length); ++j)
      store<W>(entries + (triangle(first + i) + begin + j) * W, sum[i][j]);
}

// The tiles of Height rows of the triangle from `first` on.
template <int W, int Height>
void add_strip(const double* rows, int count, int stride, int first, double* entries) {
  for (int begin = 0; begin < first; begin += kTile<W>)
    add_tile<W, Height, kTile<W>, false>(rows, count, stride, first, begin, entries);
  add_tile<W, Height, Height, true>(rows, count, stride, first, first, entries);
}

template <int W>
void add_triangle(const double* rows, int count, int columns, double* entries) {
  const int stride = columns * W;
  int first = 0;
  for (; first + kTile<W> <= columns; first += kTile<W>)
    add_strip<W, kTile<W>>(rows, count, stride, first, entries);
  switch (columns - first) {
    case 1:
      return add_strip<W, 1>(rows, count, stride, first, entries);
    case 2:
      return add_strip<W, 2>(rows, count, stride, first, entries);
    case 3:
      return add_strip<W, 3>(rows, count, stride, first, entries);
    default:
      return;
  }
}

// Derivatives of the position along a segment, made column by column for a few steps, then added. A row is
// the sum of `Together` steps: one, or two as NormalSums says. Columns: how many, 0: as the constructor says.
template <int W, int Columns, int Together>
class NormalRows {
 public:
  static constexpr int kSteps = kBlockRows * Together;  // at once

  NormalRows(int columns, const NormalSums& sums) : columns_(columns) {
    memset(jtj_, 0, sizeof(double) * static_cast<size_t>(triangle(columns) * W));
    for (int p = 0; p < columns; ++p) {
      State& s = states_[p];
      s.heading = load<W>(sums.heading0[p]);
      s.gx = s.gy = s.sum_gx = s.sum_gy = s.jtr = splat<W>(0);
    }
  }

  // How many of the steps that are left come next: the first times so many that the last row is whole.
  static int next(long left) {
    const long beyond = left % kSteps;
    return static_cast<int>(beyond != 0 ? beyond : kSteps);
  }

  // N columns side by side, from `first` on with `apart` between them. change(k, steps[k], heading, x, y):
  // sets the changes (x[N], y[N]) of the derivatives in step k, and moves the derivatives heading[N] of the
  // heading on.
  template <int N, class StepOf, class Change>
  [[gnu::always_inline]] inline void columns(int first, int apart, const StepOf* steps, int count,
                                             const Change& change) {
    Pack<W> heading[N], gx[N], gy[N], sum_gx[N], sum_gy[N], jtr[N];
#pragma GCC unroll 4
    for (int n = 0; n < N; ++n) {
      const State& s = states_[first + n * apart];
      heading[n] = s.heading, gx[n] = s.gx, gy[n] = s.gy;
      sum_gx[n] = s.sum_gx, sum_gy[n] = s.sum_gy, jtr[n] = s.jtr;
    }
    const int stride = (Columns > 0 ? Columns : columns_) * W;
    double* to = rows_ + first * W;
    const auto step = [&](int k) __attribute__((always_inline)) {
      Pack<W> x[N], y[N];
      const StepOf& t = steps[k];
      change(k, t, heading, x, y);
#pragma GCC unroll 4
      for (int n = 0; n < N; ++n) {
        gx[n] = gx[n] + x[n];
        gy[n] = gy[n] + y[n];
        jtr[n] = jtr[n] + (gx[n] * t.ex + gy[n] * t.ey);
      }
    };
    const auto row = [&](int k, int steps_of_row) __attribute__((always_inline)) {
      Pack<W> rx[N], ry[N];
      step(k);
#pragma GCC unroll 4
      for (int n = 0; n < N; ++n) rx[n] = gx[n], ry[n] = gy[n];
      if (steps_of_row == 2) {
        step(k + 1);
#pragma GCC unroll 4
        for (int n = 0; n < N; ++n) rx[n] = rx[n] + gx[n], ry[n] = ry[n] + gy[n];
      }
#pragma GCC unroll 4
      for (int n = 0; n < N; ++n) {
        sum_gx[n] = sum_gx[n] + rx[n];
        sum_gy[n] = sum_gy[n] + ry[n];
        store<W>(to + n * apart * W, rx[n]);
        store<W>(to + n * apart * W + stride, ry[n]);
      }
      to += 2 * stride;
    };
    const int alone = count % Together;
    if (alone != 0) row(0, 1);
    for (int k = alone; k < count; k += Together) row(k, Together);
#pragma GCC unroll 4
    for (int n = 0; n < N; ++n)
      states_[first + n * apart] = {heading[n], gx[n], gy[n], sum_gx[n], sum_gy[n], jtr[n]};
  }
  void add(int count) {
    add_triangle<W>(rows_, 2 * ((count + Together - 1) / Together), columns_, jtj_);
  }

  void end(NormalSums& sums) const {
    for (int p = 0; p < columns_; ++p) {
      const State& s = states_[p];
      store<W>(sums.gx[p], s.gx);
      store<W>(sums.gy[p], s.gy);
      store<W>(sums.sum_gx[p], s.sum_gx);
      store<W>(sums.sum_gy[p], s.sum_gy);
      store<W>(sums.jtr[p], s.jtr);
    }
    for (int i = 0; i < triangle(columns_); ++i)
      store<W>(sums.jtj[i], (1.0 / Together) * load<W>(jtj_ + i * W));
  }

 private:
  struct State {
    Pack<W> heading, gx, gy, sum_gx, sum_gy, jtr;
  };
  int columns_;
  State states_[kMostColumns];
  alignas(64) double rows_[2 * kBlockRows * kMostColumns * W];
  alignas(64) double jtj_[triangle(kMostColumns) * W];
};

}  // namespace
}  // namespace odobench::kernel
