// Discretisation against independent 60-digit values, closed forms and the published closure of a circle.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "problems/kalman/covariance.hpp"
#include "problems/kalman/linear_system.hpp"
#include "problems/kalman/triangular.hpp"
#include "tests/support/data/report_records.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

Matrix matrix(const json& rows) {
  Matrix m(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows.at(0).size()));
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      m(i, j) = rows.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j)).get<double>();
  return m;
}

double relative(const Matrix& found, const Matrix& expected) {
  return (found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

LinearSystem system_of(const json& c) {
  LinearSystem s;
  s.name = c.at("name").get<std::string>();
  s.a = matrix(c.at("A"));
  s.b = matrix(c.at("B"));
  s.g = matrix(c.at("G"));
  s.qc = matrix(c.at("Qc"));
  return s;
}

LinearSystem constant_acceleration(double intensity) {
  LinearSystem s;
  s.name = "constant acceleration";
  s.a = Matrix::Zero(3, 3);
  s.a(0, 1) = s.a(1, 2) = 1;
  s.b = s.g = Vector::Unit(3, 2);
  s.qc = Matrix::Constant(1, 1, intensity);
  return s;
}

// The article's second example: a point that turns with the angular velocity w.
LinearSystem turn(const Eigen::Vector3d& w) {
  LinearSystem s;
  s.name = "turn";
  s.a = Matrix::Zero(6, 6);
  s.a.topRightCorner(3, 3).setIdentity();
  s.a.bottomRightCorner(3, 3) << 0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0;
  s.b = Matrix(6, 0);
  s.g = Matrix(6, 0);
  s.qc = Matrix(0, 0);
  return s;
}

TEST(LinearSystem, MatchesTheReferenceTo13Digits) {
  ODOBENCH_NEEDS_SHARED();
  const json cases = testing::reference_json("discretisation.json").at("cases");
  ASSERT_EQ(cases.size(), 12u);
  for (const json& c : cases) {
    const double t = c.at("T").get<double>();
    SCOPED_TRACE(c.at("name").get<std::string>() + " " + std::to_string(t));
    const LinearSystem s = system_of(c);
    const Discretisation d = discretise(s, t);
    EXPECT_LE(relative(d.f, matrix(c.at("F"))), 1e-13);
    EXPECT_LE(relative(d.psi, matrix(c.at("Psi"))), 1e-13);
    EXPECT_LE(relative(d.gamma, matrix(c.at("Gamma"))), 1e-13);
    EXPECT_LE(relative(d.q, matrix(c.at("Q"))), 1e-13);
    EXPECT_LE(relative(piecewise_constant_noise(d.gamma, s.qc / t), matrix(c.at("Q_zoh"))), 1e-13);
    EXPECT_EQ((d.q - d.q.transpose()).cwiseAbs().maxCoeff(), 0);
    for (const auto& [order, f] : c.at("F_series").items()) {
      const SeriesDiscretisation series = discretise_series(s, t, std::stoi(order));
      EXPECT_LE(relative(series.value.f, matrix(f)), 1e-13) << order;
      EXPECT_NEAR(series.f_error, c.at("F_series_maxabs_err").at(order).get<double>(),
                  1e-13 * (1 + series.f_error));
      EXPECT_LE(series.f_error, series.f_bound * (1 + 1e-9) + 1e-13);
    }
    for (const auto& [order, integral] : c.at("int_series").items())
      EXPECT_LE(relative(discretise_series(s, t, std::stoi(order)).integral, matrix(integral)), 1e-13)
          << order;
  }
}

TEST(LinearSystem, ConstantAccelerationHasItsClosedForm) {
  const double t = 0.7, q = 0.3;
  const Discretisation d = discretise(constant_acceleration(q), t);
  Matrix f(3, 3), noise(3, 3);
  f << 1, t, t * t / 2, 0, 1, t, 0, 0, 1;
  noise << std::pow(t, 5) / 20, std::pow(t, 4) / 8, std::pow(t, 3) / 6, std::pow(t, 4) / 8,
      std::pow(t, 3) / 3, t * t / 2, std::pow(t, 3) / 6, t * t / 2, t;
  EXPECT_LE(relative(d.f, f), 1e-15);
  EXPECT_LE(relative(d.psi, Eigen::Vector3d(t * t * t / 6, t * t / 2, t)), 1e-15);
  EXPECT_LE(relative(d.q, q * noise), 2e-15);
}

TEST(LinearSystem, ATurnIsRodrigues) {
  const Eigen::Vector3d w(0.3, -0.7, 1.1);
  const double t = 0.9, o = w.norm();
  const LinearSystem s = turn(w);
  const Matrix x = s.a.bottomRightCorner(3, 3), id = Matrix::Identity(3, 3);
  const Matrix vv = id + std::sin(o * t) / o * x + (1 - std::cos(o * t)) / (o * o) * x * x;
  const Matrix pv =
      t * id + (1 - std::cos(o * t)) / (o * o) * x + (o * t - std::sin(o * t)) / (o * o * o) * x * x;
  const Discretisation d = discretise(s, t);
  EXPECT_LE(relative(d.f.bottomRightCorner(3, 3), vv), 1e-14);
  EXPECT_LE(relative(d.f.topRightCorner(3, 3), pv), 1e-14);
  EXPECT_EQ(d.psi.cols(), 0);
  EXPECT_EQ(d.q.cwiseAbs().maxCoeff(), 0);
}

Eigen::Vector3d closure(const Matrix& f) {
  Vector x = Vector::Zero(6);
  x[3] = 10;
  const Vector start = x;
  for (int k = 0; k < 100; ++k) x = f * x;
  return (start - x).head<3>();
}

TEST(LinearSystem, TheCircleClosesAsPublished) {
  const double c = 2 * std::acos(-1.0) / 100 / std::sqrt(2.0);
  const LinearSystem s = turn({0, c, c});
  const auto order = [&](int n) { return closure(discretise_series(s, 1, n).value.f); };
  // Printed: [-0.00051924 -0.0072984 0.0072984]
  char text[3][32];
  for (int i = 0; i < 3; ++i) std::snprintf(text[i], sizeof text[i], "%.5g", order(3)[i]);
  EXPECT_STREQ(text[0], "-0.00051924");
  EXPECT_STREQ(text[1], "-0.0072984");
  EXPECT_STREQ(text[2], "0.0072984");
  EXPECT_NEAR(order(3)[0], -0.00051923768839752371, 1e-12);
  EXPECT_NEAR(order(3)[1], -0.0072984008938405678, 1e-12);
  EXPECT_NEAR(order(2)[0], -0.657319, 1e-6);
  EXPECT_NEAR(order(1)[1], 24.5006, 1e-4);
  EXPECT_NEAR(order(4)[0], 1.29696e-4, 1e-9);
  EXPECT_LE(closure(discretise(s, 1).f).norm(), 2e-12);
}

TEST(LinearSystem, FastDecayDoesNotSpoilTheNoise) {
  LinearSystem s;
  s.a = Matrix::Constant(1, 1, -50);
  s.b = Matrix(1, 0);
  s.g = Matrix::Constant(1, 1, 1e-6);
  s.qc = Matrix::Constant(1, 1, 4);
  const Discretisation d = discretise(s, 20);  // a single e^{-AT} would be e^1000
  EXPECT_NEAR(d.q(0, 0) / (4e-12 / 100), 1, 1e-13);
}

TEST(LinearSystem, InputsOfVeryDifferentSizeKeepTheirDigits) {
  LinearSystem s = constant_acceleration(1e-12);
  s.b *= 1e12;
  s.g *= 1e-9;
  const Discretisation d = discretise(s, 0.1), one = discretise(constant_acceleration(1), 0.1);
  EXPECT_LE(relative(d.psi / 1e12, one.psi), 1e-15);
  EXPECT_LE(relative(d.gamma / 1e-9, one.gamma), 1e-15);
  EXPECT_LE(relative(d.q / 1e-30, one.q), 1e-14);
}

TEST(LinearSystem, BoundsHoldAndAreNotWild) {
  LinearSystem s = turn({0.5, -0.4, 0.3});
  for (const double t : {0.1, 1.0, 8.0})
    for (const int n : {1, 3, 6, 12, 30}) {
      const SeriesDiscretisation series = discretise_series(s, t, n);
      EXPECT_LE(series.f_error, series.f_bound + 1e-14) << t << " " << n;
      if (t < 2 && n < 12) {
        EXPECT_GE(series.f_error, 1e-4 * series.f_bound) << t << " " << n;
      }
    }
}

TEST(LinearSystem, RefusesWhatDoesNotFit) {
  const LinearSystem good = constant_acceleration(1);
  LinearSystem s = good;
  s.a = Matrix::Zero(3, 2);
  EXPECT_THAT(testing::usage_error([&] { discretise(s, 1); }),
              HasSubstr("A is 3 x 2, expected a square matrix"));
  s = good;
  s.a = Matrix(0, 0);
  EXPECT_THAT(testing::usage_error([&] { discretise(s, 1); }), HasSubstr("A is 0 x 0"));
  s = good;
  s.b = Matrix::Zero(2, 1);
  EXPECT_THAT(testing::usage_error([&] { discretise(s, 1); }), HasSubstr("B is 2 x 1, expected 3 rows"));
  s = good;
  s.g = Matrix::Zero(4, 1);
  EXPECT_THAT(testing::usage_error([&] { discretise(s, 1); }), HasSubstr("G is 4 x 1"));
  s = good;
  s.qc = Matrix::Identity(2, 2);
  EXPECT_THAT(testing::usage_error([&] { discretise(s, 1); }), HasSubstr("Qc is 2 x 2, expected 1 x 1"));
  s = good;
  s.qc(0, 0) = -0.1;
  EXPECT_THAT(testing::usage_error([&] { discretise(s, 1); }), HasSubstr("Qc has the eigenvalue -0.1"));
  s = good;
  s.a(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(testing::usage_error([&] { discretise(s, 1); }),
              HasSubstr("A has an entry that is not finite"));
  s = good;
  s.states = {{"x", "m"}};
  EXPECT_THAT(testing::usage_error([&] { discretise(s, 1); }), HasSubstr("1 names of states, expected 3"));
  EXPECT_THAT(testing::usage_error([&] { discretise(good, 0); }), HasSubstr("period 0"));
  EXPECT_THAT(testing::usage_error([&] { discretise(good, -1); }), HasSubstr("period -1"));
  EXPECT_THAT(testing::usage_error([&] { discretise_series(good, 1, 0); }), HasSubstr("series order 0"));
  EXPECT_THAT(testing::usage_error([&] { piecewise_constant_noise(Matrix::Zero(3, 2), Matrix::Zero(1, 1)); }),
              HasSubstr("expected 2 x 2"));
  s = good;
  s.a = Matrix::Identity(3, 3);
  EXPECT_THAT(testing::usage_error([&] { discretise(s, 1e4); }), HasSubstr("leave the range"));
  EXPECT_EQ(testing::usage_error([&] { discretise(good, 1); }), "");
}

TEST(Covariance, IsCheckedAndFactored) {
  Matrix p(2, 2);
  p << 4, 2, 2, 3;
  const Matrix s = covariance_factor("P", p);
  EXPECT_LE((s * s.transpose() - p).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(s(0, 1), 0);
  Matrix singular(2, 2);
  singular << 1, 2, 2, 4;
  const Matrix root = covariance_factor("P", singular);
  EXPECT_LE((root * root.transpose() - singular).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_THAT(testing::usage_error([&] { covariance_factor("P", singular, Definiteness::Positive); }),
              HasSubstr("P has the eigenvalue"));
  p(1, 1) = 0.5;
  EXPECT_THAT(testing::usage_error([&] { covariance_factor("P", p); }), HasSubstr("eigenvalue -0.4"));
  p(1, 0) = 2.1;
  EXPECT_THAT(testing::usage_error([&] { covariance_factor("P", p); }), HasSubstr("not symmetric"));
  EXPECT_THAT(testing::usage_error([&] { covariance_factor("R", Matrix::Zero(2, 3)); }),
              HasSubstr("R is 2 x 3"));
}

TEST(Triangular, KeepsTheProduct) {
  Eigen::Matrix<double, 3, 7> m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 7; ++j) m(i, j) = std::sin(1 + 5 * i + 3 * j + i * j);
  const Eigen::Matrix3d s = lower_triangular<3, 7>(m);
  EXPECT_LE((squared<3>(s) - m * m.transpose()).cwiseAbs().maxCoeff(), 1e-14);
  for (int i = 0; i < 3; ++i) {
    EXPECT_GE(s(i, i), 0);
    for (int j = i + 1; j < 3; ++j) EXPECT_EQ(s(i, j), 0);
  }
  const Matrix narrow = m.leftCols(2);  // fewer columns than rows: rank 2
  const Matrix t = lower_triangular<Eigen::Dynamic, Eigen::Dynamic>(narrow);
  EXPECT_LE((t * t.transpose() - narrow * narrow.transpose()).cwiseAbs().maxCoeff(), 1e-14);
}

}  // namespace
}  // namespace odobench
