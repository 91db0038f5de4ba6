#include "problems/trust/noise_scoring.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace odobench::noise {
namespace {

constexpr double kFarthest = 16.26623620;  // 99.9 % of chi-square(3)
// E min(x, kFarthest) / 3 of chi-square(3) = F_5(c) + c (1 - F_3(c)) / 3.
constexpr double kKept = 0.99929841;
constexpr double kMostCorrelation = 0.99;
constexpr int kMostRounds = 80;
constexpr double kSettled = 1e-5;

using Square = Eigen::Matrix<double, kNoiseTerms, kNoiseTerms>;
using Terms = Eigen::Matrix<double, kNoiseTerms, 1>;

struct Equations {
  Square a = Square::Zero();
  Terms b = Terms::Zero();
  int held_back = 0;
};

// Off-diagonal entries count twice in a trace of products.
Eigen::Matrix<double, 6, 1> packed(const Eigen::Matrix3d& m) {
  constexpr double kTwice = 1.4142135623730951;
  Eigen::Matrix<double, 6, 1> v;
  v << m(0, 0), m(1, 1), m(2, 2), kTwice * m(0, 1), kTwice * m(0, 2), kTwice * m(1, 2);
  return v;
}

// Standard deviations below which nothing is asked: the covariance must have an inverse.
Eigen::Vector3d smallest_variance(const std::vector<Segment>& segments) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Segment& s : segments) mean += s.error.cwiseAbs2() / static_cast<double>(segments.size());
  return 1e-8 * mean + Eigen::Vector3d::Constant(1e-20);
}

Equations equations(const std::vector<Segment>& segments, const NoiseModel& model,
                    const std::array<bool, kNoiseTerms>& wanted, const Eigen::Vector3d& smallest) {
  Equations out;
  Eigen::Matrix<double, 6, kNoiseTerms> c;
  c.setZero();
  for (const Segment& s : segments) {
    Eigen::Matrix3d p = covariance_of(model, s);
    p.diagonal() += smallest;
    const Eigen::LLT<Eigen::Matrix3d> llt(p);
    if (llt.info() != Eigen::Success) continue;
    const Eigen::Matrix3d inverse = llt.matrixL().solve(Eigen::Matrix3d::Identity());  // L^-1
    const Eigen::Vector3d e = inverse * s.error;
    const double nees = e.squaredNorm();
    const double share = std::min(1.0, kFarthest / std::max(nees, 1e-300)) / kKept;
    if (nees > kFarthest) ++out.held_back;
    for (int m = 0; m < kNoiseTerms; ++m)
      if (wanted[m]) c.col(m) = packed(inverse * s.basis[m] * inverse.transpose());
    const Eigen::Matrix<double, 6, 1> found =
        packed(share * e * e.transpose() - inverse * smallest.asDiagonal() * inverse.transpose());
    out.a.noalias() += s.weight * c.transpose() * c;
    out.b.noalias() += s.weight * c.transpose() * found;
  }
  return out;
}

// min 1/2 x'Ax - b'x, x >= 0, over the first n of `free`: Lawson and Hanson's active sets.
Vector not_negative(const Matrix& a, const Vector& b) {
  const Eigen::Index n = b.size();
  Vector x = Vector::Zero(n);
  std::vector<bool> in(static_cast<std::size_t>(n), false);
  const auto solve = [&] {
    std::vector<Eigen::Index> list;
    for (Eigen::Index i = 0; i < n; ++i)
      if (in[static_cast<std::size_t>(i)]) list.push_back(i);
    Vector y = Vector::Zero(n);
    if (list.empty()) return y;
    const Matrix aa = a(list, list);
    const Vector yy = aa.completeOrthogonalDecomposition().solve(Vector(b(list)));
    for (std::size_t k = 0; k < list.size(); ++k) y[list[k]] = yy[static_cast<Eigen::Index>(k)];
    return y;
  };
  for (int round = 0; round < 10 * static_cast<int>(n); ++round) {
    const Vector gradient = b - a * x;
    Eigen::Index enter = -1;
    for (Eigen::Index i = 0; i < n; ++i)
      if (!in[static_cast<std::size_t>(i)] && gradient[i] > 1e-12 * b.cwiseAbs().maxCoeff() &&
          (enter < 0 || gradient[i] > gradient[enter]))
        enter = i;
    if (enter < 0) break;
    in[static_cast<std::size_t>(enter)] = true;
    for (Vector y = solve();; y = solve()) {
      double step = 1;
      Eigen::Index leave = -1;
      for (Eigen::Index i = 0; i < n; ++i)
        if (in[static_cast<std::size_t>(i)] && y[i] <= 0 && x[i] / std::max(x[i] - y[i], 1e-300) < step) {
          step = x[i] / std::max(x[i] - y[i], 1e-300);
          leave = i;
        }
      x += step * (y - x);
      if (leave < 0) break;
      x[leave] = 0;
      in[static_cast<std::size_t>(leave)] = false;
    }
  }
  return x;
}

// Solves for the variances with the covariances held, in units in which A has a diagonal of 1.
void solve_variances(const Equations& e, const std::array<bool, kNoiseTerms>& wanted, NoiseModel& model) {
  std::vector<Eigen::Index> list;
  for (Eigen::Index m = 0; m < kNoiseVariances; ++m)
    if (wanted[static_cast<std::size_t>(m)] && e.a(m, m) > 0) list.push_back(m);
  Terms rest = e.b;
  for (int m = kNoiseVariances; m < kNoiseTerms; ++m) rest -= e.a.col(m) * model.value[m];
  const auto n = static_cast<Eigen::Index>(list.size());
  Vector scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale[i] = 1 / std::sqrt(e.a(list[i], list[i]));
  const Matrix a = scale.asDiagonal() * Matrix(e.a(list, list)) * scale.asDiagonal();
  const Vector x = not_negative(a, scale.cwiseProduct(Vector(rest(list))));
  for (Eigen::Index i = 0; i < n; ++i) model.value[list[i]] = scale[i] * x[i];
}

// Two covariances of one heading variance: their correlations lie in a disc.
void keep_inside(double first, double second, double heading, double& one, double& other) {
  const double limit = kMostCorrelation * kMostCorrelation;
  if (first <= 0 || heading <= 0) one = 0;
  if (second <= 0 || heading <= 0) other = 0;
  const double sum = (first > 0 && heading > 0 ? one * one / (first * heading) : 0) +
                     (second > 0 && heading > 0 ? other * other / (second * heading) : 0);
  if (sum <= limit) return;
  const double factor = std::sqrt(limit / sum);
  one *= factor;
  other *= factor;
}

void solve_covariances(const Equations& e, const std::array<bool, kNoiseTerms>& wanted, NoiseModel& model) {
  std::vector<Eigen::Index> list;
  for (Eigen::Index m = kNoiseVariances; m < kNoiseTerms; ++m)
    if (wanted[static_cast<std::size_t>(m)] && e.a(m, m) > 0) list.push_back(m);
  Terms rest = e.b;
  for (int m = 0; m < kNoiseVariances; ++m) rest -= e.a.col(m) * model.value[m];
  if (!list.empty()) {
    const Vector x = Matrix(e.a(list, list)).completeOrthogonalDecomposition().solve(Vector(rest(list)));
    for (std::size_t i = 0; i < list.size(); ++i) model.value[list[i]] = x[static_cast<Eigen::Index>(i)];
  }
  auto& v = model.value;
  keep_inside(v[kAlong], v[kAcross], v[kHeading], v[kAlongHeading], v[kAcrossHeading]);
  keep_inside(v[kForward], v[kSideways], v[kTurn], v[kForwardTurn], v[kSidewaysTurn]);
}

// A third of the scatter of each component to each of its terms.
NoiseModel first_guess(const std::vector<Segment>& segments, const std::array<bool, kNoiseTerms>& wanted) {
  NoiseModel model;
  double metres = 0, radians = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  const auto n = static_cast<double>(segments.size());
  for (const Segment& s : segments) {
    metres += s.metres / n;
    radians += s.radians / n;
    mean += s.error.cwiseAbs2() / n;
  }
  const double position = (mean[0] + mean[1]) / 6, heading = mean[2] / 3;
  const double per_m = 1 / std::max(metres, 1e-6), per_rad = 1 / std::max(radians, 1e-6);
  model.value = {position * per_m,   position * per_m,  heading * per_m, position * per_rad,
                 position * per_rad, heading * per_rad, position / 2,    heading / 2};
  for (int m = 0; m < kNoiseTerms; ++m)
    if (!wanted[m]) model.value[m] = 0;
  return model;
}

}  // namespace

Scored score(const std::vector<Segment>& segments, const std::array<bool, kNoiseTerms>& wanted,
             const NoiseModel* start) {
  Scored out;
  if (segments.empty()) return out;
  const Eigen::Vector3d smallest = smallest_variance(segments);
  NoiseModel& model = out.model;
  model = start != nullptr ? *start : first_guess(segments, wanted);
  for (int round = 0; round < kMostRounds; ++round) {
    const Equations e = equations(segments, model, wanted, smallest);
    out.held_back = e.held_back;
    for (int m = 0; m < kNoiseTerms; ++m) out.deviation[m] = e.a(m, m) > 0 ? std::sqrt(2 / e.a(m, m)) : 0;
    NoiseModel next = model;
    for (int k = 0; k < 3; ++k) {
      solve_variances(e, wanted, next);
      solve_covariances(e, wanted, next);
    }
    // Half steps where whole ones go to and fro.
    const double part = round < 8 ? 1 : 0.5;
    double change = 0, size = 0;
    for (int m = 0; m < kNoiseTerms; ++m) {
      const double step = part * (next.value[m] - model.value[m]);
      change += e.a(m, m) * step * step;
      size += e.a(m, m) * next.value[m] * next.value[m];
      model.value[m] += step;
    }
    if (change <= kSettled * kSettled * size) break;
  }
  return out;
}

}  // namespace odobench::noise
