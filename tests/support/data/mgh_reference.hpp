// The residuals of the problems of More, Garbow and Hillstrom once more, plainly as the paper writes them and
// in any precision: what problems/classic/mgh_*.cpp is checked against. T: long double, or a type of
// Boost.Multiprecision.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace odobench::testing {

template <class T>
T decimal(const char* digits) {
  if constexpr (std::is_same_v<T, long double>)
    return std::strtold(digits, nullptr);
  else
    return T(digits);
}

// Decimal fractions a / 10^k, rounded in T and not in double.
template <class T>
std::vector<T> decimals(const std::vector<long>& numerators, long denominator) {
  std::vector<T> v;
  for (const long a : numerators) v.push_back(T(a) / T(denominator));
  return v;
}

template <class T>
std::vector<T> mgh_fixed_reference(const std::string& name, const std::vector<T>& x, int m) {
  using std::abs, std::atan, std::cos, std::exp, std::log, std::pow, std::sin, std::sqrt;
  std::vector<T> r;
  const auto each = [&](const auto& residual) {
    for (int i = 1; i <= m; ++i) r.push_back(residual(i, T(i)));
    return r;
  };
  const auto at = [](const std::vector<T>& v, int i) { return v.at(static_cast<std::size_t>(i - 1)); };
  if (name == "rosenbrock") return {10 * (x[1] - x[0] * x[0]), 1 - x[0]};
  if (name == "freudenstein-roth")
    return {-13 + x[0] + ((5 - x[1]) * x[1] - 2) * x[1], -29 + x[0] + ((x[1] + 1) * x[1] - 14) * x[1]};
  if (name == "powell-badly-scaled")
    return {10000 * x[0] * x[1] - 1, exp(-x[0]) + exp(-x[1]) - decimal<T>("1.0001")};
  if (name == "brown-badly-scaled") return {x[0] - 1000000, x[1] - decimal<T>("2e-6"), x[0] * x[1] - 2};
  if (name == "beale") {
    const auto y = decimals<T>({1500, 2250, 2625}, 1000);
    return each([&](int i, T) { return at(y, i) - x[0] * (1 - pow(x[1], i)); });
  }
  if (name == "jennrich-sampson")
    return each([&](int, T i) { return T(2 + 2 * i - (exp(i * x[0]) + exp(i * x[1]))); });
  if (name == "helical-valley") {
    const T turn = 8 * atan(T(1));
    const T theta = atan(x[1] / x[0]) / turn + (x[0] > 0 ? T(0) : T(1) / 2);
    return {10 * (x[2] - 10 * theta), 10 * (sqrt(x[0] * x[0] + x[1] * x[1]) - 1), x[2]};
  }
  if (name == "bard") {
    const auto y = decimals<T>({14, 18, 22, 25, 29, 32, 35, 39, 37, 58, 73, 96, 134, 210, 439}, 100);
    return each([&](int i, T u) {
      const T v = 16 - u, w = u < v ? u : v;
      return T(at(y, i) - (x[0] + u / (v * x[1] + w * x[2])));
    });
  }
  if (name == "gaussian") {
    const auto y =
        decimals<T>({9, 44, 175, 540, 1295, 2420, 3521, 3989, 3521, 2420, 1295, 540, 175, 44, 9}, 10000);
    return each([&](int i, T u) {
      const T d = (8 - u) / 2 - x[2];
      return T(x[0] * exp(-x[1] * d * d / 2) - at(y, i));
    });
  }
  if (name == "meyer") {
    const auto y = decimals<T>({34780, 28610, 23650, 19630, 16370, 13720, 11540, 9744, 8261, 7030, 6005, 5147,
                                4427, 3820, 3307, 2872},
                               1);
    return each([&](int i, T u) { return T(x[0] * exp(x[1] / (45 + 5 * u + x[2])) - at(y, i)); });
  }
  if (name == "gulf")
    return each([&](int, T u) {
      const T t = u / 100, y = 25 + pow(-50 * log(t), T(2) / 3);
      return T(exp(-pow(abs(y - x[1]), x[2]) / x[0]) - t);
    });
  if (name == "box-3d")
    return each([&](int, T u) {
      const T t = u / 10;
      return T(exp(-t * x[0]) - exp(-t * x[1]) - x[2] * (exp(-t) - exp(-10 * t)));
    });
  if (name == "powell-singular")
    return {x[0] + 10 * x[1], sqrt(T(5)) * (x[2] - x[3]), pow(x[1] - 2 * x[2], 2),
            sqrt(T(10)) * pow(x[0] - x[3], 2)};
  if (name == "wood")
    return {10 * (x[1] - x[0] * x[0]),          1 - x[0],
            sqrt(T(90)) * (x[3] - x[2] * x[2]), 1 - x[2],
            sqrt(T(10)) * (x[1] + x[3] - 2),    (x[1] - x[3]) / sqrt(T(10))};
  if (name == "kowalik-osborne") {
    const auto y = decimals<T>({1957, 1947, 1735, 1600, 844, 627, 456, 342, 323, 235, 246}, 10000);
    const auto u = decimals<T>({40000, 20000, 10000, 5000, 2500, 1670, 1250, 1000, 833, 714, 625}, 10000);
    return each([&](int i, T) {
      const T v = at(u, i);
      return T(at(y, i) - x[0] * (v * v + v * x[1]) / (v * v + v * x[2] + x[3]));
    });
  }
  if (name == "brown-dennis")
    return each([&](int, T u) {
      const T t = u / 5;
      return T(pow(x[0] + t * x[1] - exp(t), 2) + pow(x[2] + x[3] * sin(t) - cos(t), 2));
    });
  if (name == "osborne-1") {
    const auto y =
        decimals<T>({844, 908, 932, 936, 925, 908, 881, 850, 818, 784, 751, 718, 685, 658, 628, 603, 580,
                     558, 538, 522, 506, 490, 478, 467, 457, 448, 438, 431, 424, 420, 414, 411, 406},
                    1000);
    return each([&](int i, T u) {
      const T t = 10 * (u - 1);
      return T(at(y, i) - (x[0] + x[1] * exp(-t * x[3]) + x[2] * exp(-t * x[4])));
    });
  }
  if (name == "biggs-exp6")
    return each([&](int, T u) {
      const T t = u / 10, y = exp(-t) - 5 * exp(-10 * t) + 3 * exp(-4 * t);
      return T(x[2] * exp(-t * x[0]) - x[3] * exp(-t * x[1]) + x[5] * exp(-t * x[4]) - y);
    });
  if (name == "osborne-2") {
    const auto y =
        decimals<T>({1366, 1191, 1112, 1013, 991, 885, 831, 847, 786, 725, 746, 679, 608, 655, 616, 606, 602,
                     626,  651,  724,  649,  649, 694, 644, 624, 661, 612, 558, 533, 495, 500, 423, 395, 375,
                     372,  391,  396,  405,  428, 429, 523, 562, 607, 653, 672, 708, 633, 668, 645, 632, 591,
                     559,  597,  625,  739,  710, 729, 720, 636, 581, 428, 292, 162, 98,  54},
                    1000);
    return each([&](int i, T u) {
      const T t = (u - 1) / 10;
      return T(at(y, i) - (x[0] * exp(-t * x[4]) + x[1] * exp(-pow(t - x[8], 2) * x[5]) +
                           x[2] * exp(-pow(t - x[9], 2) * x[6]) + x[3] * exp(-pow(t - x[10], 2) * x[7])));
    });
  }
  throw std::invalid_argument(name);
}

template <class T>
std::vector<T> mgh_variable_reference(const std::string& name, const std::vector<T>& x, int m) {
  using std::cos, std::exp, std::pow, std::sin, std::sqrt;
  const int n = static_cast<int>(x.size());
  const auto at = [&](int j) { return j < 1 || j > n ? T(0) : x[static_cast<std::size_t>(j - 1)]; };
  const auto sum = [](int from, int to, const auto& term) {
    T s = 0;
    for (int j = from; j <= to; ++j) s += term(j);
    return s;
  };
  const T a = sqrt(decimal<T>("1e-5")), h = T(1) / (n + 1);
  const auto t = [&](int i) { return T(i * h); };
  const auto cube = [&](int j) { return T(pow(at(j) + t(j) + 1, 3)); };
  const auto residual = [&](int i) -> T {
    const T u = i;
    if (name == "watson") {
      if (i == 30) return at(1);
      if (i == 31) return at(2) - at(1) * at(1) - 1;
      const T v = u / 29;
      return sum(2, n, [&](int j) { return T((j - 1) * at(j) * pow(v, j - 2)); }) -
             pow(sum(1, n, [&](int j) { return T(at(j) * pow(v, j - 1)); }), 2) - 1;
    }
    if (name == "extended-rosenbrock") return i % 2 == 1 ? 10 * (at(i + 1) - at(i) * at(i)) : 1 - at(i - 1);
    if (name == "extended-powell-singular") {
      if (i % 4 == 1) return at(i) + 10 * at(i + 1);
      if (i % 4 == 2) return sqrt(T(5)) * (at(i + 1) - at(i + 2));
      if (i % 4 == 3) return pow(at(i - 1) - 2 * at(i), 2);
      return sqrt(T(10)) * pow(at(i - 3) - at(i), 2);
    }
    if (name == "penalty-1")
      return i <= n ? T(a * (at(i) - 1)) : T(sum(1, n, [&](int j) { return T(at(j) * at(j)); }) - T(1) / 4);
    if (name == "penalty-2") {
      if (i == 1) return at(1) - T(1) / 5;
      if (i <= n) return a * (exp(at(i) / 10) + exp(at(i - 1) / 10) - (exp(u / 10) + exp((u - 1) / 10)));
      if (i < 2 * n) return a * (exp(at(i - n + 1) / 10) - exp(T(-1) / 10));
      return sum(1, n, [&](int j) { return T((n - j + 1) * at(j) * at(j)); }) - 1;
    }
    if (name == "variably-dimensioned") {
      if (i <= n) return at(i) - 1;
      return pow(sum(1, n, [&](int j) { return T(j * (at(j) - 1)); }), i - n);
    }
    if (name == "trigonometric")
      return n - sum(1, n, [&](int j) { return T(cos(at(j))); }) + i * (1 - cos(at(i))) - sin(at(i));
    if (name == "brown-almost-linear") {
      if (i < n) return at(i) + sum(1, n, [&](int j) { return at(j); }) - (n + 1);
      T product = 1;
      for (const T& value : x) product *= value;
      return product - 1;
    }
    if (name == "discrete-boundary-value") return 2 * at(i) - at(i - 1) - at(i + 1) + h * h * cube(i) / 2;
    if (name == "discrete-integral-equation")
      return at(i) + h *
                         ((1 - t(i)) * sum(1, i, [&](int j) { return T(t(j) * cube(j)); }) +
                          t(i) * sum(i + 1, n, [&](int j) { return T((1 - t(j)) * cube(j)); })) /
                         2;
    if (name == "broyden-tridiagonal") return (3 - 2 * at(i)) * at(i) - at(i - 1) - 2 * at(i + 1) + 1;
    if (name == "broyden-banded")
      return at(i) * (2 + 5 * at(i) * at(i)) + 1 -
             sum(i - 5, i + 1, [&](int j) { return j == i ? T(0) : T(at(j) * (1 + at(j))); });
    if (name == "linear-full-rank") return at(i) - T(2) / m * sum(1, n, at) - 1;
    if (name == "linear-rank-1") return i * sum(1, n, [&](int j) { return T(j * at(j)); }) - 1;
    if (name == "linear-rank-1-zero")
      return i == m ? T(-1) : T((i - 1) * sum(2, n - 1, [&](int j) { return T(j * at(j)); }) - 1);
    if (name == "chebyquad")
      return sum(1, n,
                 [&](int j) {
                   T before = 1, now = 2 * at(j) - 1;
                   for (int k = 1; k < i; ++k) {
                     const T next = 2 * (2 * at(j) - 1) * now - before;
                     before = now;
                     now = next;
                   }
                   return now;
                 }) /
                 n +
             (i % 2 == 0 ? T(1) / (u * u - 1) : T(0));
    throw std::invalid_argument(name);
  };
  std::vector<T> r;
  for (int i = 1; i <= m; ++i) r.push_back(residual(i));
  return r;
}

}  // namespace odobench::testing
