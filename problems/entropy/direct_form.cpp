#include "problems/entropy/direct_form.hpp"

#include <cmath>

namespace odobench {
namespace {

using IncrementsRef = Eigen::Ref<const Eigen::VectorXd>;

// The measurements as (2.29) compares them.
struct Measured {
  explicit Measured(const EntropyWindow& window)
      : c(window.constants), encoders(window.samples.size()), accelerations(window.samples.size() - 1) {
    const double a = alpha(c), sin_a = std::sin(a), cos_a = std::cos(a);
    for (std::size_t n = 0; n < encoders.size(); ++n) {
      const EntropySample& s = window.samples[n];
      Encoders& e = encoders[n];
      for (std::size_t w = 0; w < 4; ++w) {  // (2.20)-(2.23)
        const double cx = s.wheel[w] * std::cos(s.steering[w]), cy = s.wheel[w] * std::sin(s.steering[w]);
        e.x[w] = cx * cos_a - cy * sin_a;
        e.y[w] = cy * cos_a + cx * sin_a;
        const double sign_x = w < 2 ? 1 : -1, sign_y = w == 0 || w == 3 ? 1 : -1;
        e.turn += sign_y * cy * cos_a + sign_x * cx * sin_a;
      }
      e.rotation = s.rotation;
      if (n + 1 == encoders.size()) break;
      const EntropySample& next = window.samples[n + 1];
      accelerations[n] = {(s.ax + next.ax) / 2.0, (s.ay + next.ay) / 2.0};
    }
  }

  struct Encoders {
    double x[4], y[4];  // m, filter frame
    double turn = 0;    // R(n): what of them is rotation
    double rotation = 0;
  };
  const EntropyConstants& c;
  std::vector<Encoders> encoders;
  std::vector<std::array<double, 2>> accelerations;
};

struct Axis {
  double sum = 0;           // of the wheels' displacements over all samples
  double moment = 0;        // sum of (n - 1 - (N-1)/2) times the wheels' displacements of sample n
  double acceleration = 0;  // sum of the neighbour means of the accelerometer
};

// sx1, ax12 of one axis; `d(j)` is its acceleration increment j = 1..N-2.
template <class Increment>
void closed_axis(const EntropyConstants& c, const Axis& data, const Increment& d, double& s1, double& a12) {
  const int big_n = c.samples;
  const double t = c.dt * c.dt, middle = (big_n - 1) / 2.0;
  const double se2 = c.sigma_encoder * c.sigma_encoder, sa2 = c.sigma_acceleration * c.sigma_acceleration;
  double lag = 0, shift = 0, bend = 0;
  for (int j = 1; j <= big_n - 2; ++j) {
    double z = 0;
    for (int n = 1; n <= big_n; ++n) z += (n - 1) * std::max(0, n - 1 - j);
    const double s = (big_n - 1 - j) * (big_n - j) / 2.0;
    lag += (big_n - 1 - j) * d(j);
    shift += s * d(j);
    bend += (z - middle * s) * d(j);
  }
  const double cubic = big_n * (big_n * big_n - 1.0) / 3.0;
  a12 = (se2 * (data.acceleration - lag) + t * sa2 * (data.moment - 4.0 * t * bend)) /
        ((big_n - 1) * se2 + cubic * t * t * sa2);
  s1 = (data.sum - 4.0 * t * shift) / (4.0 * big_n) - middle * t * a12;
}

// Calls `term(difference, sigma)` for every term of (2.29) in its order: accelerations, encoders, gyro.
template <class Term>
void for_each_term(const Measured& measured, const IncrementsRef& increments, const EntropyState& state,
                   const Term& term) {
  const EntropyConstants& c = measured.c;
  const int big_n = c.samples;
  const double t = c.dt * c.dt, k = degrees_per_metre(c), a = alpha(c);
  const double sin_2a = std::sin(2.0 * a), cos_2a = std::cos(2.0 * a);
  double ax = state.ax12, ay = state.ay12;
  for (int m = 1; m <= big_n - 1; ++m) {
    if (m > 1) {
      ax += increments[2 * (m - 2)];
      ay += increments[2 * (m - 2) + 1];
    }
    term(ax - measured.accelerations[m - 1][0], c.sigma_acceleration);
    term(ay - measured.accelerations[m - 1][1], c.sigma_acceleration);
  }
  ax = state.ax12;
  ay = state.ay12;
  double sx = state.sx1, sy = state.sy1, r = state.r1;
  for (int n = 1; n <= big_n; ++n) {
    const Measured::Encoders& e = measured.encoders[n - 1];
    const double x[4] = {sx, sx + r * sin_2a, sx, sx - r * sin_2a};
    const double y[4] = {sy + r, sy - r * cos_2a, sy - r, sy + r * cos_2a};
    for (std::size_t w = 0; w < 4; ++w) {
      term(x[w] - e.x[w], c.sigma_encoder);
      term(y[w] - e.y[w], c.sigma_encoder);
    }
    term(k * r - e.rotation, c.sigma_rotation);
    if (n == big_n) break;
    if (n > 1) {
      ax += increments[2 * (n - 2)];
      ay += increments[2 * (n - 2) + 1];
    }
    sx += t * ax;
    sy += t * ay;
    r += t / k * increments[2 * (big_n - 2) + n - 1];
  }
}

EntropyState closed_form(const Measured& measured, const IncrementsRef& increments) {
  const EntropyConstants& c = measured.c;
  const int big_n = c.samples;
  const double k = degrees_per_metre(c);
  const double se2 = c.sigma_encoder * c.sigma_encoder, st2 = c.sigma_rotation * c.sigma_rotation;
  Axis x, y;
  double turn = 0, gyro = 0, eps = 0;
  for (int n = 1; n <= big_n; ++n) {
    const Measured::Encoders& e = measured.encoders[n - 1];
    const double weight = n - 1 - (big_n - 1) / 2.0;
    const double sum_x = e.x[0] + e.x[1] + e.x[2] + e.x[3], sum_y = e.y[0] + e.y[1] + e.y[2] + e.y[3];
    x.sum += sum_x;
    y.sum += sum_y;
    x.moment += weight * sum_x;
    y.moment += weight * sum_y;
    turn += e.turn;
    gyro += e.rotation;
    if (n == big_n) break;
    x.acceleration += measured.accelerations[n - 1][0];
    y.acceleration += measured.accelerations[n - 1][1];
    eps += (big_n - n) * increments[2 * (big_n - 2) + n - 1];
  }
  EntropyState state;
  const double weight = 4.0 / se2 + k * k / st2;
  state.r1 = (turn / se2 + k * gyro / st2) / (big_n * weight) - c.dt * c.dt / (k * big_n) * eps;
  closed_axis(
      c, x, [&](int j) { return increments[2 * (j - 1)]; }, state.sx1, state.ax12);
  closed_axis(
      c, y, [&](int j) { return increments[2 * (j - 1) + 1]; }, state.sy1, state.ay12);
  return state;
}

double hamiltonian(const Measured& measured, const IncrementsRef& increments, const EntropyState& state) {
  double h = 0;
  for_each_term(measured, increments, state,
                [&](double difference, double sigma) { h -= difference * difference / (sigma * sigma); });
  return h;
}

}  // namespace

EntropyState closed_form(const EntropyWindow& window, const IncrementsRef& increments) {
  return closed_form(Measured(window), increments);
}

double hamiltonian(const EntropyWindow& window, const IncrementsRef& increments, const EntropyState& state) {
  return hamiltonian(Measured(window), increments, state);
}

void hamiltonian_residuals(const EntropyWindow& window, const IncrementsRef& increments,
                           const EntropyState& state, Eigen::Ref<Eigen::VectorXd> residuals) {
  Eigen::Index i = 0;
  for_each_term(Measured(window), increments, state,
                [&](double difference, double sigma) { residuals[i++] = difference / sigma; });
}

DirectSearch direct_search(const EntropyWindow& window) {
  DirectSearch result;
  const Measured measured(window);
  const int size = increment_count(window.constants.samples);
  result.t = Eigen::VectorXd::Zero(size);
  const auto evaluate = [&] {
    const Eigen::VectorXd values = increments(window.constants, result.t);
    result.state = closed_form(measured, values);
    ++result.evaluations;
    return hamiltonian(measured, values, result.state);
  };
  double current = evaluate();
  for (bool done = false; !done;) {
    ++result.iterations;
    int choice = -1;
    double best = current, best_value = 0;
    for (int j = 0; j < 2 * size; ++j) {
      const int i = j / 2;
      const double before = result.t[i];
      const double candidate = j % 2 == 0 ? (before == 1 ? 0 : 1) : (before == -1 ? 0 : -1);
      result.t[i] = candidate;
      const double h = evaluate();
      result.t[i] = before;
      if (h > best) {
        best = h;
        best_value = candidate;
        choice = i;
      }
    }
    if (choice < 0) {
      done = true;
    } else {
      result.t[choice] = best_value;
      current = best;
    }
  }
  result.hamiltonian = evaluate();
  return result;
}

}  // namespace odobench
