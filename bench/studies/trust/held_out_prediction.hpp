// What a model costs on recordings that it has not seen, without fitting it again.
#pragma once

#include <optional>

#include "problems/calibration/recording_costs.hpp"

namespace odobench {

// Takeuchi's correction, stratified by kind of drive:
//     J_held = J(z) + 2 R/(R-1) tr(Hx^-1 B)
// on the free parameters at z (off their bounds), Hx half the Hessian of J by central differences of J'r, in
// its place J'J where Hx is not positive definite,
//     B = sum_kinds k/(k-1) sum_n (g_n - mean of the kind)(g_n - mean of the kind)',  g_n = J_n'r_n,
// k recordings of the kind, R = the smallest k: of a leave-one-repetition-out validation J summed over the
// recordings that are left out. A hint: the folds themselves may end in other valleys. Nothing where a kind
// has one recording, no parameter is free, or J'J is singular.
std::optional<double> predicted_held_out_cost(const RecordingCosts& recordings, const Vector& z);

}  // namespace odobench
