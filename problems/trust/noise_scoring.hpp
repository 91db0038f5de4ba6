// Variances of a model whose covariances are linear in them: a private header of odometry_noise.cpp.
#pragma once

#include <array>
#include <vector>

#include "problems/trust/noise_segments.hpp"

namespace odobench::noise {

struct Scored {
  NoiseModel model;
  int held_back = 0;
  // 1/sqrt(A_mm / 2): standard deviation of a term by the curvature, the others held, were all segments
  // independent.
  std::array<double, kNoiseTerms> deviation{};
};

// Fisher scoring (T. W. Anderson, Ann. Statist. 1, 1973): with W = Sigma(value)^-1
//     A_mn = sum w tr(W B_m W B_n),  b_m = sum w e' W B_m W e,   min 1/2 v'Av - b'v
// over the terms that are `wanted`, variances not negative, correlations of the heading at most 0.99. A
// segment whose e'We is beyond the 99.9 % quantile of chi-square(3) counts as if it lay there, and all are
// divided by what this takes from the mean of normal errors. `start` null: from the scatter of the segments.
Scored score(const std::vector<Segment>& segments, const std::array<bool, kNoiseTerms>& wanted,
             const NoiseModel* start = nullptr);

}  // namespace odobench::noise
