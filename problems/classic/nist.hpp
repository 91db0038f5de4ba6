// The 27 nonlinear regression problems of the NIST Statistical Reference Datasets
// (https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml, public domain), each with its two official
// starts: nist:NAME/1 is the start far from the solution, nist:NAME/2 the near one.
//
// r_i = f(b, x_i) - y_i (Nelson: f - log y_i), J = r'r. Parameters b1, b2, ... as NIST counts them.
// Box: |b_j| <= 10 max(|start 1_j|, |start 2_j|, |certified_j|), the same for both starts.
// known_optimum() is the certified residual sum of squares, known_minimisers() the certified parameters (11
// digits) and those that give the same curve by a symmetry of the model inside the box (exchanged
// exponentials, peaks or cycles, the sign of a width). Costs are not finite where a model is not defined or
// overflows.
//
// The months of ENSO are whole numbers: a cycle of b months there also looks like one of 1 / (k +- 1/b)
// months for every whole k, so that it has further answers of the same cost with a period of about one month
// or less, which are not listed. Lanczos1 is data without noise to 12 digits, J* = 1.43e-25: there double
// precision determines the cost to a few per cent only.
#pragma once

#include <string>
#include <vector>

#include "problems/classic/classic_problems.hpp"

namespace odobench {

struct NistData {
  std::string name;
  std::string model;                 // NIST's formula, e.g. "b1*(1-exp(-b2*x))"
  std::vector<std::string> columns;  // "y", then the predictors
  std::vector<Vector> starts;        // the two official ones
  Vector certified;
  double certified_rss = 0;
  Matrix observations;  // one row each, columns as above
};

// All 27 in alphabetical order, from data/nist_strd.txt, which is part of the program.
const std::vector<NistData>& nist_data();

// Two for each of them.
std::vector<ClassicEntry> nist_entries();
// `name`: "nist:NAME/1" or "nist:NAME/2" of nist_entries(). Throws std::invalid_argument on another one.
Problem make_nist_problem(const std::string& name);

}  // namespace odobench
