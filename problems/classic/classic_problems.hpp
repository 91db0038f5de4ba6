// Problems without data of their own, for the conformance tests and for comparing methods. Three families:
//
// classic: small test functions.
//   sphere      J = sum (x_i - 1/3)^2                                        box [-1, 1]^n
//   ellipsoid   J = |D Q (x - c)|^2, D_i = 10^(3 (i-1)/(n-1)), Q a fixed rotation: a rotated valley of
//               condition 1e6
//   corner      the ellipsoid with c outside the box: the optimum lies on bounds (proven by active sets)
//   rosenbrock  J = sum 100 (x_{i+1} - x_i^2)^2 + (1 - x_i)^2 (Rosenbrock 1960), box [-2, 2]^n
//   powell      Powell's singular function (1962), n = 4, box [-4, 5]^4: J'J singular at the optimum
//   rastrigin   J = sum x_i^2 - 10 cos(2 pi x_i) + 10, box [-5.12, 4.12]^n: many local minima, gradient only
//   step        J = sum floor(|4 x_i|): piecewise constant, no derivatives
// nist: nist:NAME/1 and nist:NAME/2, the certified regression problems of nist.hpp.
// mgh:  mgh:NAME, mgh:NAME/10, mgh:NAME/100, the test problems of more_garbow_hillstrom.hpp.
// All parameters are dimensionless. docs/problems.md lists them with sources and best known costs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problems/problem.hpp"

namespace odobench {

// Dimensions that a problem takes: least, least + step, ... up to most.
struct DimensionRule {
  int least = 2;
  int most = 2;
  int step = 1;
  static DimensionRule exactly(int n) { return {n, n, 1}; }
  static DimensionRule at_least(int n, int step = 1);
  bool allows(int n) const;
  // "4", ">= 2", "2..31", "4, 8, 12, ...".
  std::string text() const;
};

// What is known about a problem without making it.
struct ClassicEntry {
  std::string name;    // as make_classic_problem takes it
  std::string family;  // "classic", "nist", "mgh", or a suite: "bbob", "mw", "robots"
  int dimension = 0;   // the usual one
  DimensionRule dimensions;
  int residuals = 0;  // at the usual dimension; 0: the cost is no sum of squares
  std::string source;
  std::optional<double> best_cost;  // lowest known cost in the box at the usual dimension
  int instances = 0;                // numbered ones, from 1, which is the usual one; 0: there is but one
  std::string hard = {};            // what makes it hard, in a line
};

// Every problem, grouped by family, in the order in which lists show them.
const std::vector<ClassicEntry>& classic_catalogue();
const std::vector<std::string>& classic_problem_names();
// Null when there is no such problem.
const ClassicEntry* find_classic_problem(const std::string& name);

// `dimension` 0: the usual one. Throws std::invalid_argument on an unknown name or a dimension that the
// problem does not take.
Problem make_classic_problem(const std::string& name, int dimension = 0);

// Correct digits of the worst parameter, NIST's log relative error:
//     LRE(x) = max over the known minimisers c of min_i -log10(|x_i - c_i| / |c_i|), in [0, 11]
// (-log10 |x_i| where c_i = 0), 0 for an x that is not finite. The minimisers are those of
// Problem::known_minimisers(): an answer with two terms of a sum exchanged is as right as the certified one.
// Throws std::invalid_argument on an empty list or one of another dimension.
double log_relative_error(const ConstVectorRef& x, const std::vector<Vector>& minimisers);
inline constexpr double kMostDigits = 11;

// Whether x with cost J is the known answer. nist: problems, whose parameters are certified: log relative
// error >= 6. bbob: J - J* <= 1e-8, as COCO has it. Others: J - J* <= max(1e-6 |J*|, 1e-12); their costs are
// of the order of 1. Throws std::logic_error without a known optimum.
bool reaches_known_optimum(const Problem& problem, const ConstVectorRef& x, double cost);

}  // namespace odobench
