#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "problems/classic/mgh_functions.hpp"

namespace odobench {
namespace {

using Eigen::Index;

template <int kCount>
int count(int) {
  return kCount;
}

Vector vector(std::initializer_list<double> values) {
  Vector v(static_cast<Index>(values.size()));
  std::copy(values.begin(), values.end(), v.begin());
  return v;
}

void rosenbrock(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  r << 10 * (x[1] - x[0] * x[0]), 1 - x[0];
  if (j) *j << -20 * x[0], 10, -1, 0;
}

void freudenstein_roth(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  r << -13 + x[0] + ((5 - x[1]) * x[1] - 2) * x[1], -29 + x[0] + ((x[1] + 1) * x[1] - 14) * x[1];
  if (j) *j << 1, (10 - 3 * x[1]) * x[1] - 2, 1, (3 * x[1] + 2) * x[1] - 14;
}

void powell_badly_scaled(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  r << 1e4 * x[0] * x[1] - 1, std::exp(-x[0]) + std::exp(-x[1]) - 1.0001;
  if (j) *j << 1e4 * x[1], 1e4 * x[0], -std::exp(-x[0]), -std::exp(-x[1]);
}

void brown_badly_scaled(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  r << x[0] - 1e6, x[1] - 2e-6, x[0] * x[1] - 2;
  if (j) *j << 1, 0, 0, 1, x[1], x[0];
}

void beale(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  constexpr std::array y{1.5, 2.25, 2.625};
  double power = 1;  // x2^i
  for (Index i = 0; i < 3; ++i) {
    const double slope = static_cast<double>(i + 1) * power * x[0];
    power *= x[1];
    r[i] = y[static_cast<std::size_t>(i)] - x[0] * (1 - power);
    if (j) j->row(i) << power - 1, slope;
  }
}

void jennrich_sampson(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  for (Index k = 0; k < r.size(); ++k) {
    const double i = static_cast<double>(k + 1);
    const double a = std::exp(i * x[0]), b = std::exp(i * x[1]);
    r[k] = 2 + 2 * i - (a + b);
    if (j) j->row(k) << -i * a, -i * b;
  }
}

// The angle of (x1, x2) in turns, in [-1/4, 3/4): the paper leaves x1 = 0 open, the authors' programs say
// +-1/4.
void helical_valley(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  constexpr double kTurn = 2 * std::numbers::pi;
  double theta = x[1] < 0 ? -0.25 : 0.25;
  if (x[0] != 0) theta = std::atan(x[1] / x[0]) / kTurn + (x[0] < 0 ? 0.5 : 0);
  const double radius = std::hypot(x[0], x[1]);
  r << 10 * (x[2] - 10 * theta), 10 * (radius - 1), x[2];
  if (!j) return;
  const double c = x[0] / radius,
               s = x[1] / radius;  // not a number at the origin, where the angle has no derivative
  *j << 100 / kTurn * s / radius, -100 / kTurn * c / radius, 10, 10 * c, 10 * s, 0, 0, 0, 1;
}

void bard(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  constexpr std::array y{0.14, 0.18, 0.22, 0.25, 0.29, 0.32, 0.35, 0.39,
                         0.37, 0.58, 0.73, 0.96, 1.34, 2.10, 4.39};
  for (Index i = 0; i < 15; ++i) {
    const double u = static_cast<double>(i + 1), v = 16 - u, w = std::min(u, v);
    const double d = v * x[1] + w * x[2];
    r[i] = y[static_cast<std::size_t>(i)] - (x[0] + u / d);
    if (j) j->row(i) << -1, u * v / d / d, u * w / d / d;
  }
}

void gaussian(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  constexpr std::array y{0.0009, 0.0044, 0.0175, 0.0540, 0.1295, 0.2420, 0.3521, 0.3989,
                         0.3521, 0.2420, 0.1295, 0.0540, 0.0175, 0.0044, 0.0009};
  for (Index i = 0; i < 15; ++i) {
    const double s = 0.5 * static_cast<double>(7 - i) - x[2];
    const double e = std::exp(-0.5 * x[1] * s * s);
    r[i] = x[0] * e - y[static_cast<std::size_t>(i)];
    if (j) j->row(i) << e, -0.5 * x[0] * s * s * e, x[0] * x[1] * s * e;
  }
}

void meyer(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  constexpr std::array<double, 16> y{34780, 28610, 23650, 19630, 16370, 13720, 11540, 9744,
                                     8261,  7030,  6005,  5147,  4427,  3820,  3307,  2872};
  for (Index i = 0; i < 16; ++i) {
    const double d = 45 + 5 * static_cast<double>(i + 1) + x[2];
    const double e = std::exp(x[1] / d);
    r[i] = x[0] * e - y[static_cast<std::size_t>(i)];
    if (j) j->row(i) << e, x[0] * e / d, -x[0] * e * x[1] / d / d;
  }
}

void gulf(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  for (Index i = 0; i < r.size(); ++i) {
    const double t = static_cast<double>(i + 1) / 100;
    const double y = 25 + std::pow(-50 * std::log(t), 2.0 / 3);
    const double distance = std::abs(y - x[1]);
    const double p = std::pow(distance, x[2]) / x[0];
    const double e = std::exp(-p);
    r[i] = e - t;
    if (!j || e == 0 || p == 0) continue;  // far away all is flat, also where p overflows
    const double slope = x[2] * std::pow(distance, x[2] - 1) / x[0];
    j->row(i) << e * p / x[0], y > x[1] ? e * slope : -e * slope, -e * p * std::log(distance);
  }
}

void box_3d(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  for (Index i = 0; i < r.size(); ++i) {
    const double t = 0.1 * static_cast<double>(i + 1);
    const double a = std::exp(-t * x[0]), b = std::exp(-t * x[1]), c = std::exp(-t) - std::exp(-10 * t);
    r[i] = a - b - x[2] * c;
    if (j) j->row(i) << -t * a, t * b, -c;
  }
}

void wood(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const double a = std::sqrt(90.0), b = std::sqrt(10.0);
  r << 10 * (x[1] - x[0] * x[0]), 1 - x[0], a * (x[3] - x[2] * x[2]), 1 - x[2], b * (x[1] + x[3] - 2),
      (x[1] - x[3]) / b;
  if (!j) return;
  *j << -20 * x[0], 10, 0, 0, -1, 0, 0, 0, 0, 0, -2 * a * x[2], a, 0, 0, -1, 0, 0, b, 0, b, 0, 1 / b, 0,
      -1 / b;
}

void kowalik_osborne(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  constexpr std::array y{0.1957, 0.1947, 0.1735, 0.1600, 0.0844, 0.0627,
                         0.0456, 0.0342, 0.0323, 0.0235, 0.0246};
  constexpr std::array u{4.0, 2.0, 1.0, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625};
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double d = u[i] * (u[i] + x[2]) + x[3], ratio = u[i] * (u[i] + x[1]) / d;
    const auto row = static_cast<Index>(i);
    r[row] = y[i] - x[0] * ratio;
    if (j) j->row(row) << -ratio, -x[0] * u[i] / d, x[0] * ratio * u[i] / d, x[0] * ratio / d;
  }
}

void brown_dennis(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  for (Index i = 0; i < r.size(); ++i) {
    const double t = static_cast<double>(i + 1) / 5;
    const double a = x[0] + t * x[1] - std::exp(t), b = x[2] + x[3] * std::sin(t) - std::cos(t);
    r[i] = a * a + b * b;
    if (j) j->row(i) << 2 * a, 2 * a * t, 2 * b, 2 * b * std::sin(t);
  }
}

void osborne_1(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  constexpr std::array y{0.844, 0.908, 0.932, 0.936, 0.925, 0.908, 0.881, 0.850, 0.818, 0.784, 0.751,
                         0.718, 0.685, 0.658, 0.628, 0.603, 0.580, 0.558, 0.538, 0.522, 0.506, 0.490,
                         0.478, 0.467, 0.457, 0.448, 0.438, 0.431, 0.424, 0.420, 0.414, 0.411, 0.406};
  for (Index i = 0; i < 33; ++i) {
    const double t = 10 * static_cast<double>(i);
    const double a = std::exp(-t * x[3]), b = std::exp(-t * x[4]);
    r[i] = y[static_cast<std::size_t>(i)] - (x[0] + x[1] * a + x[2] * b);
    if (j) j->row(i) << -1, -a, -b, x[1] * t * a, x[2] * t * b;
  }
}

void biggs_exp6(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  for (Index i = 0; i < r.size(); ++i) {
    const double t = 0.1 * static_cast<double>(i + 1);
    const double y = std::exp(-t) - 5 * std::exp(-10 * t) + 3 * std::exp(-4 * t);
    const double a = std::exp(-t * x[0]), b = std::exp(-t * x[1]), c = std::exp(-t * x[4]);
    r[i] = x[2] * a - x[3] * b + x[5] * c - y;
    if (j) j->row(i) << -t * x[2] * a, t * x[3] * b, a, -b, -t * x[5] * c, c;
  }
}

void osborne_2(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  constexpr std::array y{1.366, 1.191, 1.112, 1.013, 0.991, 0.885, 0.831, 0.847, 0.786, 0.725, 0.746,
                         0.679, 0.608, 0.655, 0.616, 0.606, 0.602, 0.626, 0.651, 0.724, 0.649, 0.649,
                         0.694, 0.644, 0.624, 0.661, 0.612, 0.558, 0.533, 0.495, 0.500, 0.423, 0.395,
                         0.375, 0.372, 0.391, 0.396, 0.405, 0.428, 0.429, 0.523, 0.562, 0.607, 0.653,
                         0.672, 0.708, 0.633, 0.668, 0.645, 0.632, 0.591, 0.559, 0.597, 0.625, 0.739,
                         0.710, 0.729, 0.720, 0.636, 0.581, 0.428, 0.292, 0.162, 0.098, 0.054};
  for (Index i = 0; i < 65; ++i) {
    const double t = static_cast<double>(i) / 10;
    const double decay = std::exp(-t * x[4]);
    double model = x[0] * decay;
    if (j) {
      (*j)(i, 0) = -decay;
      (*j)(i, 4) = t * x[0] * decay;
    }
    for (Index k = 0; k < 3; ++k) {
      const double s = t - x[8 + k];
      const double bell = std::exp(-s * s * x[5 + k]);
      model += x[1 + k] * bell;
      if (!j) continue;
      (*j)(i, 1 + k) = -bell;
      (*j)(i, 5 + k) = x[1 + k] * s * s * bell;
      (*j)(i, 8 + k) = -2 * x[1 + k] * x[5 + k] * s * bell;
    }
    r[i] = y[static_cast<std::size_t>(i)] - model;
  }
}

void powell_singular(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const double a = std::sqrt(5.0), b = std::sqrt(10.0);
  r << x[0] + 10 * x[1], a * (x[2] - x[3]), square(x[1] - 2 * x[2]), b * square(x[0] - x[3]);
  if (!j) return;
  const double s = 2 * (x[1] - 2 * x[2]), t = 2 * b * (x[0] - x[3]);
  *j << 1, 10, 0, 0, 0, 0, a, -a, 0, s, -2 * s, 0, t, 0, 0, -t;
}

}  // namespace

const std::vector<MghFunction>& mgh_fixed_functions() {
  const auto exactly = DimensionRule::exactly;
  static const std::vector<MghFunction> list{
      {"rosenbrock", "1, Rosenbrock", 2, exactly(2), count<2>,
       [](int) {
         return vector({-1.2, 1});
       },
       rosenbrock},
      {"freudenstein-roth", "2, Freudenstein and Roth", 2, exactly(2), count<2>,
       [](int) {
         return vector({0.5, -2});
       },
       freudenstein_roth},
      {"powell-badly-scaled", "3, Powell, badly scaled", 2, exactly(2), count<2>,
       [](int) {
         return vector({0, 1});
       },
       powell_badly_scaled},
      {"brown-badly-scaled", "4, Brown, badly scaled", 2, exactly(2), count<3>,
       [](int) {
         return vector({1, 1});
       },
       brown_badly_scaled},
      {"beale", "5, Beale", 2, exactly(2), count<3>,
       [](int) {
         return vector({1, 1});
       },
       beale},
      {"jennrich-sampson", "6, Jennrich and Sampson", 2, exactly(2), count<10>,
       [](int) {
         return vector({0.3, 0.4});
       },
       jennrich_sampson},
      {"helical-valley", "7, helical valley", 3, exactly(3), count<3>,
       [](int) {
         return vector({-1, 0, 0});
       },
       helical_valley},
      {"bard", "8, Bard", 3, exactly(3), count<15>,
       [](int) {
         return vector({1, 1, 1});
       },
       bard},
      {"gaussian", "9, Gaussian", 3, exactly(3), count<15>,
       [](int) {
         return vector({0.4, 1, 0});
       },
       gaussian},
      {"meyer", "10, Meyer", 3, exactly(3), count<16>,
       [](int) {
         return vector({0.02, 4000, 250});
       },
       meyer},
      {"gulf", "11, Gulf research and development", 3, exactly(3), count<99>,
       [](int) {
         return vector({5, 2.5, 0.15});
       },
       gulf},
      {"box-3d", "12, Box, three-dimensional", 3, exactly(3), count<10>,
       [](int) {
         return vector({0, 10, 20});
       },
       box_3d},
      {"powell-singular", "13, Powell, singular", 4, exactly(4), count<4>,
       [](int) {
         return vector({3, -1, 0, 1});
       },
       powell_singular},
      {"wood", "14, Wood", 4, exactly(4), count<6>,
       [](int) {
         return vector({-3, -1, -3, -1});
       },
       wood},
      {"kowalik-osborne", "15, Kowalik and Osborne", 4, exactly(4), count<11>,
       [](int) {
         return vector({0.25, 0.39, 0.415, 0.39});
       },
       kowalik_osborne},
      {"brown-dennis", "16, Brown and Dennis", 4, exactly(4), count<20>,
       [](int) {
         return vector({25, 5, -5, -1});
       },
       brown_dennis},
      {"osborne-1", "17, Osborne 1", 5, exactly(5), count<33>,
       [](int) {
         return vector({0.5, 1.5, -1, 0.01, 0.02});
       },
       osborne_1},
      {"biggs-exp6", "18, Biggs, six exponentials", 6, exactly(6), count<13>,
       [](int) {
         return vector({1, 2, 1, 1, 1, 1});
       },
       biggs_exp6},
      {"osborne-2", "19, Osborne 2", 11, exactly(11), count<65>,
       [](int) {
         return vector({1.3, 0.65, 0.65, 0.7, 0.6, 3, 5, 7, 2, 4.5, 5.5});
       },
       osborne_2}};
  return list;
}

}  // namespace odobench
