// What a validation says in words, with its figures. Functions give "" where a sentence does not apply.
#pragma once

#include <string>
#include <vector>

#include "reports/kinds/trust/validation_record.hpp"

namespace odobench {

// Total errors that are below this (metres and radians) count as equal: rounding of data without noise.
inline constexpr double kNoError = 1e-9;
// Of the total error on what was left out, against that on what was fitted.
inline constexpr double kRepeatsWithin = 1.1;
// The same against that of the nominal parameters: from here on it is worse, between 1 and this no better.
// Where nominal parameters are right already, noise alone makes a fit some per cent worse.
inline constexpr double kWorseBeyond = 1.1;

// Whether the total error on what was left out is above that of the nominal parameters, and by how much.
enum class AgainstNominal { Better, NoBetter, Worse };
AgainstNominal against_nominal(const HeldOut& figures);

// Of scheme "repetitions".
// "Worse than nominal on repetitions left out (0.512 against 0.393): do not use these parameters." or
// "No better than nominal on repetitions left out (0.0252 against 0.0250): nominal parameters do as well."
std::string worse_on_repetitions(const SchemeFigures& repetitions);
// "Repeats: error on repetitions left out 0.384 (+1.5 % against fitted)." up to kRepeatsWithin
std::string repeats(const SchemeFigures& repetitions);
// "Fits more than it learns: error on repetitions left out is 23.1 % larger than on fitted ones." beyond it
std::string fits_more_than_it_learns(const SchemeFigures& repetitions);

// Of scheme "trajectories".
// "Worse than nominal on kinds of drives that it was not fitted to (4.094 against 1.274)." or
// "No better ...".
std::string worse_on_new_kinds(const SchemeFigures& trajectories);
// "Without line_y in the fit its error would be 3.546, nominal has 0.393 (the same of circle_cw): the
// parameters hold for the kinds of drives they were fitted to." of the kind that is worst; in brackets the
// others that are worse than nominal.
std::string kinds_that_are_needed(const SchemeFigures& trajectories);
// "Better than nominal on every kind of drive left out (-34.2 % in all)."
std::string better_on_every_kind(const SchemeFigures& trajectories);

// All that apply to a record, in the order above; none without a validation.
std::vector<std::string> validation_sentences(const RunRecord& record);
// What has to be said first, above all tables: those that say "worse than nominal" and "no better". ""
// when there is nothing.
std::string validation_warning(const RunRecord& record);

}  // namespace odobench
