#include "problems/classic/nist_models.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/angle.hpp"

namespace odobench {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// b1 (b2 + x)^(-1/b3); real only for b2 + x > 0 (a negative base has a real power for a few exponents only).
double bennett5(const double* b, const double* x, double* g) {
  const double base = b[1] + x[0];
  const double power = base > 0 ? std::pow(base, -1.0 / b[2]) : kNan;
  if (g) {
    g[0] = power;
    g[1] = -b[0] * power / (b[2] * base);
    g[2] = b[0] * power * std::log(base) / (b[2] * b[2]);
  }
  return b[0] * power;
}

// b1 (1 - exp(-b2 x)), without cancellation for small b2 x.
double saturating_growth(const double* b, const double* x, double* g) {
  const double rise = -std::expm1(-b[1] * x[0]);
  if (g) {
    g[0] = rise;
    g[1] = b[0] * x[0] * std::exp(-b[1] * x[0]);
  }
  return b[0] * rise;
}

// exp(-b1 x) / (b2 + b3 x)
double chwirut(const double* b, const double* x, double* g) {
  const double denominator = b[1] + b[2] * x[0];
  const double f = std::exp(-b[0] * x[0]) / denominator;
  if (g) {
    g[0] = -x[0] * f;
    g[1] = -f / denominator;
    g[2] = -x[0] * f / denominator;
  }
  return f;
}

// b1 x^b2
double dan_wood(const double* b, const double* x, double* g) {
  const double power = std::pow(x[0], b[1]);
  if (g) {
    g[0] = power;
    g[1] = b[0] * power * std::log(x[0]);
  }
  return b[0] * power;
}

// A yearly cycle and two of unknown periods b4 and b7, x in months.
double enso(const double* b, const double* x, double* g) {
  const double year = 2 * kPi * x[0] / 12;
  double f = b[0] + b[1] * std::cos(year) + b[2] * std::sin(year);
  if (g) {
    g[0] = 1;
    g[1] = std::cos(year);
    g[2] = std::sin(year);
  }
  for (int k = 3; k < 9; k += 3) {
    const double phase = 2 * kPi * x[0] / b[k];
    const double c = std::cos(phase), s = std::sin(phase);
    f += b[k + 1] * c + b[k + 2] * s;
    if (!g) continue;
    g[k] = (b[k + 1] * s - b[k + 2] * c) * phase / b[k];
    g[k + 1] = c;
    g[k + 2] = s;
  }
  return f;
}

// (b1 / b2) exp(-z^2 / 2), z = (x - b3) / b2
double eckerle4(const double* b, const double* x, double* g) {
  const double z = (x[0] - b[2]) / b[1];
  const double bell = std::exp(-0.5 * z * z) / b[1];
  if (g) {
    const double slope =
        bell == 0 ? 0 : b[0] * bell / b[1];  // a narrow peak far away: 0, not 0 times z^2 = inf
    g[0] = bell;
    g[1] = bell == 0 ? 0 : slope * (z * z - 1);
    g[2] = bell == 0 ? 0 : slope * z;
  }
  return b[0] * bell;
}

// b1 exp(-b2 x) + b3 exp(-(x - b4)^2 / b5^2) + b6 exp(-(x - b7)^2 / b8^2)
double two_peaks(const double* b, const double* x, double* g) {
  const double decay = std::exp(-b[1] * x[0]);
  double f = b[0] * decay;
  if (g) {
    g[0] = decay;
    g[1] = -b[0] * x[0] * decay;
  }
  for (int k = 2; k < 8; k += 3) {
    const double z = (x[0] - b[k + 1]) / b[k + 2];
    const double bell = std::exp(-z * z);
    f += b[k] * bell;
    if (!g) continue;
    const double slope = 2 * b[k] * bell / b[k + 2];
    g[k] = bell;
    g[k + 1] = bell == 0 ? 0 : slope * z;
    g[k + 2] = bell == 0 ? 0 : slope * z * z;
  }
  return f;
}

// p(x) / q(x), p of degree kUp with coefficients b1.., q of degree kDown with constant term 1.
template <int kUp, int kDown>
double rational(const double* b, const double* x, double* g) {
  double p = 0, q = 0;
  for (int k = kUp; k >= 0; --k) p = p * x[0] + b[k];
  for (int k = kDown; k >= 1; --k) q = (q + b[kUp + k]) * x[0];
  q += 1;
  if (g) {
    double power = 1 / q;
    for (int k = 0; k <= kUp; ++k, power *= x[0]) g[k] = power;
    power = -p / q / q * x[0];
    for (int k = 1; k <= kDown; ++k, power *= x[0]) g[kUp + k] = power;
  }
  return p / q;
}

// b1 exp(-b2 x) + b3 exp(-b4 x) + b5 exp(-b6 x)
double lanczos(const double* b, const double* x, double* g) {
  double f = 0;
  for (int k = 0; k < 6; k += 2) {
    const double decay = std::exp(-b[k + 1] * x[0]);
    f += b[k] * decay;
    if (!g) continue;
    g[k] = decay;
    g[k + 1] = -b[k] * x[0] * decay;
  }
  return f;
}

// b1 (x^2 + b2 x) / (x^2 + b3 x + b4)
double mgh09(const double* b, const double* x, double* g) {
  const double numerator = x[0] * (x[0] + b[1]), denominator = x[0] * (x[0] + b[2]) + b[3];
  const double ratio = numerator / denominator;
  if (g) {
    g[0] = ratio;
    g[1] = b[0] * x[0] / denominator;
    g[2] = -b[0] * ratio * x[0] / denominator;
    g[3] = -b[0] * ratio / denominator;
  }
  return b[0] * ratio;
}

// b1 exp(b2 / (x + b3))
double mgh10(const double* b, const double* x, double* g) {
  const double shifted = x[0] + b[2];
  const double e = std::exp(b[1] / shifted);
  if (g) {
    g[0] = e;
    g[1] = b[0] * e / shifted;
    g[2] = -b[0] * e * b[1] / shifted / shifted;
  }
  return b[0] * e;
}

// b1 + b2 exp(-b4 x) + b3 exp(-b5 x)
double mgh17(const double* b, const double* x, double* g) {
  const double first = std::exp(-b[3] * x[0]), second = std::exp(-b[4] * x[0]);
  if (g) {
    g[0] = 1;
    g[1] = first;
    g[2] = second;
    g[3] = -b[1] * x[0] * first;
    g[4] = -b[2] * x[0] * second;
  }
  return b[0] + b[1] * first + b[2] * second;
}

// b1 (1 - (1 + u)^-2) = b1 u (2 + u) / (1 + u)^2, u = b2 x / 2
double misra1b(const double* b, const double* x, double* g) {
  const double u = 0.5 * b[1] * x[0];
  const double rise = u * (2 + u) / ((1 + u) * (1 + u));
  if (g) {
    g[0] = rise;
    g[1] = b[0] * x[0] / ((1 + u) * (1 + u) * (1 + u));
  }
  return b[0] * rise;
}

// b1 (1 - 1/s) = b1 u / (s (s + 1)), s = sqrt(1 + u), u = 2 b2 x; not defined for u <= -1
double misra1c(const double* b, const double* x, double* g) {
  const double u = 2 * b[1] * x[0];
  const double s = std::sqrt(1 + u);
  const double rise = u / (s * (s + 1));
  if (g) {
    g[0] = rise;
    g[1] = b[0] * x[0] / (s * s * s);
  }
  return b[0] * rise;
}

// b1 b2 x / (1 + b2 x)
double misra1d(const double* b, const double* x, double* g) {
  const double u = b[1] * x[0];
  if (g) {
    g[0] = u / (1 + u);
    g[1] = b[0] * x[0] / ((1 + u) * (1 + u));
  }
  return b[0] * u / (1 + u);
}

// b1 - b2 x1 exp(-b3 x2), the logarithm of y
double nelson(const double* b, const double* x, double* g) {
  const double e = x[0] * std::exp(-b[2] * x[1]);
  if (g) {
    g[0] = 1;
    g[1] = -e;
    g[2] = b[1] * x[1] * e;
  }
  return b[0] - b[1] * e;
}

// 1 / (1 + exp(t)) for any t.
double logistic(double t) {
  return 1 / (1 + std::exp(t));
}

// b1 / (1 + exp(b2 - b3 x))
double rat42(const double* b, const double* x, double* g) {
  const double t = b[1] - b[2] * x[0];
  const double s = logistic(t);
  if (g) {
    const double slope = b[0] * s * logistic(-t);
    g[0] = s;
    g[1] = -slope;
    g[2] = x[0] * slope;
  }
  return b[0] * s;
}

// b1 (1 + exp(b2 - b3 x))^(-1/b4), by the logarithm of the base, which does not overflow
double rat43(const double* b, const double* x, double* g) {
  const double t = b[1] - b[2] * x[0];
  const double base = std::max(t, 0.0) + std::log1p(std::exp(-std::abs(t)));
  const double power = std::exp(-base / b[3]);
  if (g) {
    const double slope = b[0] * power * logistic(-t) / b[3];
    g[0] = power;
    g[1] = -slope;
    g[2] = x[0] * slope;
    g[3] = b[0] * power * base / b[3] / b[3];
  }
  return b[0] * power;
}

// b1 - b2 x - atan(b3 / (x - b4)) / pi
double roszman1(const double* b, const double* x, double* g) {
  const double d = x[0] - b[3];
  if (g) {
    const double scale = kPi * (d * d + b[2] * b[2]);
    g[0] = 1;
    g[1] = -x[0];
    g[2] = -d / scale;
    g[3] = -b[2] / scale;
  }
  return b[0] - b[1] * x[0] - std::atan(b[2] / d) / kPi;
}

constexpr std::array<std::pair<std::string_view, NistModel>, 27> kModels{{
    {"Bennett5", bennett5},
    {"BoxBOD", saturating_growth},
    {"Chwirut1", chwirut},
    {"Chwirut2", chwirut},
    {"DanWood", dan_wood},
    {"ENSO", enso},
    {"Eckerle4", eckerle4},
    {"Gauss1", two_peaks},
    {"Gauss2", two_peaks},
    {"Gauss3", two_peaks},
    {"Hahn1", rational<3, 3>},
    {"Kirby2", rational<2, 2>},
    {"Lanczos1", lanczos},
    {"Lanczos2", lanczos},
    {"Lanczos3", lanczos},
    {"MGH09", mgh09},
    {"MGH10", mgh10},
    {"MGH17", mgh17},
    {"Misra1a", saturating_growth},
    {"Misra1b", misra1b},
    {"Misra1c", misra1c},
    {"Misra1d", misra1d},
    {"Nelson", nelson},
    {"Rat42", rat42},
    {"Rat43", rat43},
    {"Roszman1", roszman1},
    {"Thurber", rational<3, 3>},
}};

}  // namespace

NistModel nist_model(std::string_view problem) {
  for (const auto& [name, model] : kModels)
    if (name == problem) return model;
  return nullptr;
}

}  // namespace odobench
