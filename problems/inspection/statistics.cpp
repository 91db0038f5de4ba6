#include "problems/inspection/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace odobench::inspection {

LocalLine::LocalLine(const Vector& t, Index h) : half_(h), time_(t.array() - t.mean()) {
  const Index n = t.size();
  mean_.resize(n);
  inverse_.resize(n);
  Vector sums(n + 1), squares(n + 1);
  sums[0] = squares[0] = 0;
  for (Index k = 0; k < n; ++k) {
    sums[k + 1] = sums[k] + time_[k];
    squares[k + 1] = squares[k] + time_[k] * time_[k];
  }
  for (Index k = 0; k < n; ++k) {
    const Index a = std::max<Index>(0, k - h), b = std::min(n, k + h + 1);
    const auto count = static_cast<double>(b - a);
    mean_[k] = (sums[b] - sums[a]) / count;
    inverse_[k] = 1 / (squares[b] - squares[a] - count * mean_[k] * mean_[k]);
  }
}

Vector LocalLine::slope(const ConstVectorRef& f) const {
  const Index n = time_.size();
  Vector sums(n + 1), products(n + 1), out(n);
  sums[0] = products[0] = 0;
  for (Index k = 0; k < n; ++k) {
    const double v = f[k] - f[0];
    sums[k + 1] = sums[k] + v;
    products[k + 1] = products[k] + time_[k] * v;
  }
  for (Index k = 0; k < n; ++k) {
    const Index a = std::max<Index>(0, k - half_), b = std::min(n, k + half_ + 1);
    out[k] = (products[b] - products[a] - mean_[k] * (sums[b] - sums[a])) * inverse_[k];
  }
  return out;
}

double percentile(std::vector<double>& values, double share) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double median(std::vector<double>& values) {
  return percentile(values, 0.5);
}

double median_of_seven(const Vector& v, Index k) {
  std::array<double, 7> window{};
  const Index a = std::max<Index>(0, k - 3), b = std::min(v.size(), k + 4);
  std::copy(v.data() + a, v.data() + b, window.begin());
  const auto middle = window.begin() + (b - a) / 2;
  std::nth_element(window.begin(), middle, window.begin() + (b - a));
  return *middle;
}

Vector off_median(const Vector& v) {
  Vector e(v.size());
  for (Index k = 0; k < v.size(); ++k) e[k] = std::abs(v[k] - median_of_seven(v, k));
  return e;
}

std::vector<Stretch> stretches(const std::vector<char>& holds, Index least) {
  std::vector<Stretch> found;
  const auto n = static_cast<Index>(holds.size());
  for (Index k = 0; k < n;) {
    Index end = k;
    while (end < n && holds[static_cast<std::size_t>(end)] != 0) ++end;
    if (end - k >= least && end > k) found.push_back({k, end - 1});
    k = std::max(end, k + 1);
  }
  return found;
}

namespace {

// C(L) of `rows` by sums over the overlap.
double correlation(const Matrix& early, const Matrix& late, Index shift) {
  const Index n = early.rows() - std::abs(shift);
  const Index a = shift < 0 ? -shift : 0, b = shift > 0 ? shift : 0;
  double both = 0, own = 0, other = 0;
  for (Index row = 0; row < early.cols(); ++row) {
    const auto e = early.col(row).segment(a, n);
    const auto l = late.col(row).segment(b, n);
    const double em = e.mean(), lm = l.mean(), count = static_cast<double>(n);
    both += e.dot(l) - count * em * lm;
    own += e.squaredNorm() - count * em * em;
    other += l.squaredNorm() - count * lm * lm;
  }
  const double scale = std::sqrt(own * other);
  return scale > 0 ? both / scale : 0;
}

}  // namespace

Lag lag_of(const Matrix& early, const Matrix& late, double step, Index most, double window) {
  Lag lag;
  if (most < 1 || early.cols() - most < 3) return lag;
  const Matrix e = early.transpose(), l = late.transpose();
  Vector c(2 * most + 1);
  for (Index s = -most; s <= most; ++s) c[s + most] = correlation(e, l, s);
  Index peak = 0;
  c.maxCoeff(&peak);
  if (peak == 0 || peak == 2 * most) return lag;
  const double left = c[peak - 1], middle = c[peak], right = c[peak + 1];
  const double bend = left - 2 * middle + right;
  if (!(bend < 0)) return lag;
  const double aside = 0.5 * (left - right) / bend;
  lag.correlation = std::min(1.0, middle - 0.25 * (left - right) * aside);
  lag.seconds = (static_cast<double>(peak - most) + aside) * step;
  const double effective = static_cast<double>(e.rows()) / window;
  lag.deviation = std::sqrt((1 - lag.correlation * lag.correlation) / (effective * -bend / (step * step)));
  lag.usable = lag.correlation > 0.8;
  return lag;
}

}  // namespace odobench::inspection
