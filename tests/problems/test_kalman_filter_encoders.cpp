// The linear filter and smoother over encoders, accelerometer and gyro: against batch least squares, and what
// it has in common with the windows of the relative-entropy filter.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "problems/kalman/encoder_smoother.hpp"
#include "solvers/lattice/ternary_search.hpp"
#include "tests/support/data/entropy_windows.hpp"

namespace odobench {
namespace {

// The relative-entropy filter's window as a smoother's problem: H less what a white increment of deviation q
// costs, sum (step t)^2 / q^2, is at its largest where the smoother of the window's samples is, started with
// nothing known before them.
struct WindowSmoother {
  double s = 0, a = 0, cost = 0;  // of the first sample; sum of normalised innovations
};
WindowSmoother smooth_axis(const EntropyWindow& window, const std::vector<SampleModes>& modes, double q) {
  const EntropyConstants& c = window.constants;
  AxisSmoother axis(c.dt * c.dt, c.sigma_encoder / 2, c.sigma_acceleration, q, c.samples - 1);
  WindowSmoother out;
  for (int n = 0; n < c.samples; ++n) {  // neighbour means belong to the sample before
    const auto i = static_cast<std::size_t>(n);
    const bool last = n + 1 == c.samples;
    out.cost += axis.push(modes[i].x / 4, last ? std::nullopt : std::optional(modes[i + 1].cax));
  }
  const AxisSmoother::Value first = axis.smoothed();
  return {first.displacement, first.acceleration, out.cost};
}

struct AxisWindow {
  EntropyWindow window;
  ProfileForm profile;
  std::vector<SampleModes> modes;
  BlockQuadratic cost;
  WindowZero zero;
  explicit AxisWindow(EntropyWindow w)
      : window(std::move(w)), profile(window.constants), cost(profile.cost(window)) {
    SampleHistory history(profile);
    for (const EntropySample& sample : window.samples) history.push(sample);
    modes.assign(history.window(), history.window() + window.constants.samples);
    std::vector<double> g(static_cast<std::size_t>(increment_count(window.constants.samples)));
    zero = profile.linear_term(history.window(), g);
  }
  // The largest H - weight |t|^2 of the x increments, t unbounded.
  Vector best(double weight) const {
    const QuadraticBlock& x = cost.blocks[0];
    return 0.5 * Matrix(x.q + weight * Matrix::Identity(x.q.rows(), x.q.cols())).ldlt().solve(x.g);
  }
  EntropyState state(const Vector& x) const {
    std::vector<double> t(static_cast<std::size_t>(increment_count(window.constants.samples)), 0.0);
    std::copy(x.begin(), x.end(), t.begin());
    return profile.closed_form(zero, t);
  }
};

TEST(EncoderSmoother, IsTheWindowsHamiltonianWithWhiteIncrements) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const AxisWindow w(testing::random_window(10, seed, 3));
    const double step = w.window.constants.step_acceleration;
    const EntropyState zero = w.state(Vector::Zero(8));
    const WindowSmoother constant = smooth_axis(w.window, w.modes, 0);
    EXPECT_NEAR(constant.s, zero.sx1, 1e-12);
    EXPECT_NEAR(constant.a, zero.ax12, 1e-11);
    for (const double q : {0.01 * step, kTernaryDeviation * step, 10 * step}) {
      const double weight = step * step / (q * q);
      const Vector t = w.best(weight);
      const EntropyState best = w.state(t);
      const WindowSmoother smoother = smooth_axis(w.window, w.modes, q);
      EXPECT_NEAR(smoother.s, best.sx1, 1e-12) << q;
      EXPECT_NEAR(smoother.a, best.ax12, 1e-11) << q;
      const QuadraticBlock& x = w.cost.blocks[0];
      const double gain = x.g.dot(t) - t.dot(x.q * t) - weight * t.squaredNorm();
      EXPECT_NEAR(constant.cost - smoother.cost, gain, 1e-9 * constant.cost) << q;
    }
  }
}

// Free increments are the limit of expensive ones; bounded ones are another estimate wherever a bound holds.
TEST(EncoderSmoother, IsTheRelaxationOnlyWhereNoBoundHolds) {
  int inside = 0, outside = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    EntropyWindow window = testing::random_window(10, seed, 1);
    window.constants.step_acceleration = seed % 2 == 0 ? 0.05 : 5;
    const AxisWindow w(std::move(window));
    const auto search = box_relaxation(w.profile.blocks());
    const Vector g = w.cost.stacked_g();
    Vector x(g.size());
    const auto size = static_cast<std::size_t>(g.size());
    (void)search->minimise({g.data(), size}, {x.data(), size});
    const Vector t = x.head(8);
    const EntropyState relaxed = w.state(t);
    const WindowSmoother free = smooth_axis(w.window, w.modes, 1e7 * w.window.constants.step_acceleration);
    const bool bounded = t.lpNorm<Eigen::Infinity>() >= 1;
    (bounded ? outside : inside)++;
    if (bounded)
      EXPECT_GT(std::abs(free.a - relaxed.ax12), 1e-6) << seed;
    else
      EXPECT_NEAR(free.a, relaxed.ax12, 1e-8) << seed;
  }
  EXPECT_GE(inside, 10);
  EXPECT_GE(outside, 10);
}

// Against batch least squares over all samples so far, x and rotation, filtered and smoothed.
TEST(EncoderSmoother, IsLeastSquaresOverThePastAndTheLag) {
  const EntropyWindow run = testing::random_window(40, 5, 2);
  EntropyConstants c = run.constants;
  c.samples = 6;
  const ProfileForm profile(c);
  ModeReader reader(profile);
  EncoderSmoother smoother(profile);
  const double t = c.dt * c.dt, k = degrees_per_metre(c);
  const double qa = kTernaryDeviation * c.step_acceleration, qr = kTernaryDeviation * c.step_rotation * t / k;
  const double sr =
      1 / std::sqrt(4 / (c.sigma_encoder * c.sigma_encoder) + k * k / (c.sigma_rotation * c.sigma_rotation));
  std::vector<SampleModes> modes;
  for (int n = 1; n <= 40; ++n) {
    modes.push_back(reader.read(run.samples[static_cast<std::size_t>(n - 1)]));
    smoother.push(run.samples[static_cast<std::size_t>(n - 1)]);
    // Unknowns s(1), a(1) .. a(n): the displacements follow from them.
    Matrix a = Matrix::Zero(3 * n - 1, n + 1), ar = Matrix::Zero(2 * n - 1, n);
    Vector b = Vector::Zero(3 * n - 1), br = Vector::Zero(2 * n - 1);
    for (int i = 0; i < n; ++i) {
      const auto m = static_cast<std::size_t>(i);
      a(i, 0) = 2 / c.sigma_encoder;
      a.row(i).segment(1, i).setConstant(t * 2 / c.sigma_encoder);
      b[i] = modes[m].x / 4 * 2 / c.sigma_encoder;
      a(n + i, 1 + i) = 1 / c.sigma_acceleration;
      b[n + i] = run.samples[m].ax / c.sigma_acceleration;
      ar(i, i) = 1 / sr;
      br[i] = modes[m].rho / sr;
      if (i == 0) continue;
      a(2 * n + i - 1, 1 + i) = 1 / qa;
      a(2 * n + i - 1, i) = -1 / qa;
      ar(n + i - 1, i) = 1 / qr;
      ar(n + i - 1, i - 1) = -1 / qr;
    }
    const Vector z = a.householderQr().solve(b), zr = ar.householderQr().solve(br);
    const auto s = [&](int i) { return z[0] + t * z.segment(1, i).sum(); };
    const EntropyState now = smoother.filtered().state, late = smoother.smoothed().state;
    const int back = std::max(0, n - 6);
    EXPECT_NEAR(now.sx1, s(n - 1), 1e-12);
    EXPECT_NEAR(now.ax12, z[n], 1e-11);
    EXPECT_NEAR(now.r1, zr[n - 1], 1e-12);
    EXPECT_NEAR(late.sx1, s(back), 1e-12);
    EXPECT_NEAR(late.ax12, z[1 + back], 1e-11);
    EXPECT_NEAR(late.r1, zr[back], 1e-12);
  }
}

}  // namespace
}  // namespace odobench
