// The genetic algorithm of J. Vitko's master's thesis (University of Zagreb, 2024), as its program runs it,
// on any box.
//   start       every gene uniform in the box: nominal (0.95 + 0.1 rand) for the thesis' box of +-5 %
//   selection   roulette: f_i = 1 - J_i / sum J, normalised; N parents, drawn with replacement
//   couples     (1,2), (3,4), ...; each crosses with probability pc, otherwise the two pass unchanged
//   mutation    each gene with probability pm times a factor uniform in [factor_low, factor_high], clipped
//   elitism     a random member of the new generation gives way to the best of the old one if that is better
// Crossovers of parents p, q. The sums are s = c p + (1-c) q and t = (1-c) p + c q with one c, uniform in
// [0, 1), per couple.
//   0 one point, cut in 1..m-1          1 sums, then one point between them        2 sums only
//   3 each gene from a random parent, the other one's for the second child        4 sums, then 3 between them
//   5 blend: b = (2u)^(1/(eta+1)), u <= 1/2, else (1/(2(1-u)))^(1/(eta+1)), one b for all genes;
//     children ((1+b) p + (1-b) q) / 2 and ((1-b) p + (1+b) q) / 2: Deb's simulated binary crossover, which
//     the program calls BLX               6 sums, then 5 between them
// The program evaluates the offspring and then the whole new generation once more; here a value that is known
// is not computed again, so that a generation costs N evaluations instead of 2 N and 600 generations
// 601 N.
#pragma once

#include "solvers/population/genetic.hpp"

namespace odobench {

Outcome minimise_genetic_thesis(Run& run, const GeneticOptions& options);

// N = costs.size() draws with replacement. Members with infinite cost are never drawn, unless no wheel can be
// made of the costs (all infinite, all but one, or of mixed sign): then all are equal.
std::vector<Eigen::Index> roulette(Random& random, const Vector& costs);

// Replaces the parents p, q by their children; kind 0..6 as above. p + q is the same before and after.
void thesis_crossover(Random& random, int kind, double eta, Vector& p, Vector& q);

}  // namespace odobench
