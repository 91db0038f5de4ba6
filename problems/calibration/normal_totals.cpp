#include "problems/calibration/normal_totals.hpp"

#include <algorithm>

namespace odobench {

using kernel::kMaxWidth;
using kernel::kMostColumns;

NormalTotals::NormalTotals(int columns, double cost)
    : columns_(columns),
      cost_(cost),
      gx_(static_cast<std::size_t>(columns)),
      gy_(gx_.size()),
      jtr_(gx_.size() * kMaxWidth),
      jtj_(static_cast<std::size_t>(kernel::triangle(columns) * kMaxWidth)) {}

void NormalTotals::start(double x, double y) {
  cost_ += drive_cost_;
  drive_cost_ = 0;
  x_ = x;
  y_ = y;
  std::fill(gx_.begin(), gx_.end(), 0.0);
  std::fill(gy_.begin(), gy_.end(), 0.0);
}

void NormalTotals::add(const kernel::NormalSums& sums, int width, long steps, const double* reference_x,
                       const double* reference_y) {
  switch (width) {
    case 1:
      return add_lanes<1>(sums, steps, reference_x, reference_y);
    case 2:
      return add_lanes<2>(sums, steps, reference_x, reference_y);
    case 4:
      return add_lanes<4>(sums, steps, reference_x, reference_y);
    default:
      return add_lanes<kMaxWidth>(sums, steps, reference_x, reference_y);
  }
}

template <int Width>
void NormalTotals::add_lanes(const kernel::NormalSums& sums, long steps, const double* reference_x,
                             const double* reference_y) {
  const auto n = static_cast<double>(steps);
  const kernel::CostSums& c = sums.cost;
  double ex0[kMaxWidth], ey0[kMaxWidth];
  for (int lane = 0; lane < Width; ++lane) {
    ex0[lane] = x_ - reference_x[lane];
    ey0[lane] = y_ - reference_y[lane];
    drive_cost_ += c.squares[lane] + 2 * (ex0[lane] * c.ex[lane] + ey0[lane] * c.ey[lane]) +
                   n * (ex0[lane] * ex0[lane] + ey0[lane] * ey0[lane]);
    x_ += c.x[lane];
    y_ += c.y[lane];
  }
  // g0 of every lane, and sum g + n/2 g0.
  double x0[kMostColumns][kMaxWidth], y0[kMostColumns][kMaxWidth];
  double sx[kMostColumns][kMaxWidth], sy[kMostColumns][kMaxWidth];
  for (int p = 0; p < columns_; ++p) {
    const auto column = static_cast<std::size_t>(p);
    double* jtr = &jtr_[column * kMaxWidth];
    for (int lane = 0; lane < Width; ++lane) {
      const double gx = gx_[column], gy = gy_[column];
      x0[p][lane] = gx;
      y0[p][lane] = gy;
      sx[p][lane] = sums.sum_gx[p][lane] + 0.5 * n * gx;
      sy[p][lane] = sums.sum_gy[p][lane] + 0.5 * n * gy;
      jtr[lane] += sums.jtr[p][lane] + sums.sum_gx[p][lane] * ex0[lane] + sums.sum_gy[p][lane] * ey0[lane] +
                   gx * (c.ex[lane] + n * ex0[lane]) + gy * (c.ey[lane] + n * ey0[lane]);
      gx_[column] += sums.gx[p][lane];
      gy_[column] += sums.gy[p][lane];
    }
  }
  double* jtj = jtj_.data();
  const auto* within = sums.jtj;
  for (int i = 0; i < columns_; ++i)
    for (int j = 0; j <= i; ++j, ++within, jtj += kMaxWidth)
      for (int lane = 0; lane < Width; ++lane)
        jtj[lane] += (*within)[lane] + (sx[i][lane] * x0[j][lane] + x0[i][lane] * sx[j][lane]) +
                     (sy[i][lane] * y0[j][lane] + y0[i][lane] * sy[j][lane]);
}

Vector NormalTotals::jtr() const {
  Vector sum(columns_);
  for (Eigen::Index p = 0; p < columns_; ++p)
    sum[p] = Eigen::Map<const Vector>(&jtr_[static_cast<std::size_t>(p * kMaxWidth)], kMaxWidth).sum();
  return sum;
}

Matrix NormalTotals::jtj() const {
  Matrix sum(columns_, columns_);
  const double* entry = jtj_.data();
  for (Eigen::Index i = 0; i < columns_; ++i)
    for (Eigen::Index j = 0; j <= i; ++j, entry += kMaxWidth)
      sum(i, j) = sum(j, i) = Eigen::Map<const Vector>(entry, kMaxWidth).sum();
  return sum;
}

}  // namespace odobench
