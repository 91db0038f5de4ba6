// The Hamiltonian of the relative-entropy filter term by term, a straight transcription of (2.20)-(2.29): the
// reference for tests and benchmarks; the profile form (profile_form.hpp) is what solvers and the filter use.
#pragma once

#include "problems/entropy/entropy_model.hpp"

namespace odobench {

// r1, sx1, sy1, ax12, ay12 that maximise H for given increments (3N-5, physical units).
EntropyState closed_form(const EntropyWindow& window, const Eigen::Ref<const Eigen::VectorXd>& increments);

// H = - sum_m [(ax_m - cax_m)^2 + (ay_m - cay_m)^2] / sigma_a^2 - sum_{w,n} [(encx_w - ex_w)^2 + (ency_w -
// ey_w)^2] / sigma_e^2
//     - sum_n (k r_n - c_n)^2 / sigma_theta^2,                                                        (2.29),
//       to be maximised
double hamiltonian(const EntropyWindow& window, const Eigen::Ref<const Eigen::VectorXd>& increments,
                   const EntropyState& state);

// The residuals whose squares sum to -H, in the order of the sums above: 2(N-1) + 8N + N.
void hamiltonian_residuals(const EntropyWindow& window, const Eigen::Ref<const Eigen::VectorXd>& increments,
                           const EntropyState& state, Eigen::Ref<Eigen::VectorXd> residuals);

struct DirectSearch {
  Eigen::VectorXd t;  // 3N-5, each -1, 0 or 1
  double hamiltonian = 0;
  EntropyState state;
  int iterations = 0;    // scans, the last and unsuccessful one included
  long evaluations = 0;  // of H: 2 + 2(3N-5) iterations
};

// The thesis' search, literally: from t = 0 every scan evaluates 2(3N-5) candidates, j even: t_i := (t_i == 1
// ? 0 : 1), j odd: t_i := (t_i == -1 ? 0 : -1), i = j / 2, and keeps the first one of strictly largest H
// above the current one.
DirectSearch direct_search(const EntropyWindow& window);

}  // namespace odobench
