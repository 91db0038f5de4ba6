// What tables and figures of this folder have in common.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reports/statistics/optimisers/friedman.hpp"
#include "reports/statistics/optimisers/trials.hpp"

namespace odobench {

inline constexpr std::array<double, 4> kGaps{1e-1, 1e-3, 1e-5, 1e-7};
inline constexpr double kLastGap = kGaps.back();
inline constexpr double kAlpha = 0.05;

struct RankScores {
  std::vector<std::vector<double>> scores;  // problems x solvers, smaller is better
  FriedmanTest test;
  double critical_difference = 0;
};
RankScores rank_scores(const TrialTable& table);

// log10 ERT(b) - log10 ERT(a) per problem, a and b solvers by number.
std::vector<double> log_ratios(const TrialTable& table, std::size_t a, std::size_t b);

// Whether there is enough to say anything about.
bool enough_trials(const TrialTable& table);

}  // namespace odobench
