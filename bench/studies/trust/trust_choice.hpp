// What --validate, --bootstrap, --bootstrap-scheme, --profile, --profile-steps and --combination say.
#pragma once

#include <string>
#include <vector>

#include "bench/studies/trust/bootstrap.hpp"
#include "bench/studies/trust/profile_likelihood.hpp"
#include "problems/information/formula.hpp"

namespace odobench {

struct ValidationChoice {
  // Nothing was said: both questions, where the data allow them and it takes less than
  // kAutomaticValidation_s.
  bool automatic = true;
  bool repetitions = true, trajectories = true;
  int k_fold = 0;            // folds; 0: not asked for
  bool own_solvers = false;  // "all": every row is refitted by its own solver

  bool wanted() const { return repetitions || trajectories || k_fold > 0; }
};

inline constexpr double kAutomaticValidation_s = 2;

// "repetitions", "trajectories", "kfold:K" separated by commas; "all": both questions, by each row's own
// solver; "none". Throws std::invalid_argument "--validate=TEXT: ..." for anything else.
ValidationChoice validation_choice(const std::string& text);

struct TrustChoice {
  ValidationChoice validation;
  int bootstrap = 0;  // replicates; 0: none
  ResampleScheme scheme = ResampleScheme::Stratified;
  ProfileChoice profile;
  std::vector<Formula> combinations;  // with different names
};

}  // namespace odobench
