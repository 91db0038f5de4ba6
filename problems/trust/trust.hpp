// How far a calibration can be trusted: what its drives determine, with intervals that hold, and what the box
// decides. docs/uncertainty.md explains the figures; intervals.hpp and covariances.hpp have the equations.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "problems/trust/intervals.hpp"
#include "problems/trust/twist_map.hpp"

namespace odobench {

// A number of the twist map (problems/trust/twist_map.hpp), on the free parameters.
struct DeterminedNumber {
  TwistNumber number;
  Interval interval;  // in the number's unit
};

// A single parameter, in its unit: CR3 over all parameters, only while no bound is active and where the
// interval is narrower than the box.
struct ParameterInterval {
  std::string name, unit;
  double value = 0;
  double box_half_width = 0;
  Interval interval;
};

// Half widths of an error on a drive that is yet to be made.
struct DriveError {
  std::string drive;   // "10 m along x", "full turn", or a kind of the set: its end pose
  std::string what;    // "along", "aside", "heading", "x", "y"
  std::string unit;    // "m" or "rad"
  double scatter = 0;  // root mean square of the end errors of that kind, which the interval holds, too
  Interval interval;
};

// What a number of the map would move by with arcs instead of explicit Euler steps, to first order: an error
// that all recordings share, which no interval holds. Euler's path lags behind half of every step's turn.
struct RuleShift {
  std::string name, words;
  double shift = 0, half_width = 0;  // in the number's unit
};

struct Trust {
  std::size_t recordings = 0, kinds = 0;  // G, K
  std::vector<std::string> active;        // parameters on a bound, "a1"
  std::size_t free = 0;                   // parameters that are free and on no bound
  bool exact_hessian = false;             // else J'J
  Vector hessian_eigenvalues;             // of the exact Hessian of J/2 in q of the free ones, ascending
  std::vector<DeterminedNumber> determined;
  bool map_linear = true;
  // Headings alone are compared (position weight 0): numbers and drives are those of turns, no length is
  // among them.
  bool ratios_only = false;
  std::vector<std::string> map_remarks;
  std::vector<ParameterInterval> parameters;  // all whose bounds differ
  std::vector<DriveError> drives;
  // Beyond half of their intervals, where J is lower by arcs; and that J, to first order (not-a-number where
  // nobody looked).
  std::vector<RuleShift> moved_by_rule;
  double cost_by_arcs = std::numeric_limits<double>::quiet_NaN();
  KindTest kind_test;
  // Errors repeat within each of at least twelve kinds, none of which decides a direction alone: intervals of
  // new kinds are taken between kinds, those of the same drives between recordings.
  bool between_kinds = false;
  Vector leverages;  // of every recording, in all parameters whose bounds differ
  // What has to be said below the tables, a sentence each; the last is kWhatIntervalsHold wherever there is
  // an interval.
  std::vector<std::string> sentences;
};

inline constexpr const char* kWhatIntervalsHold =
    "Intervals come from the spread between recordings; an error common to all of them is not in them.";

struct TrustOptions {
  bool exact_hessian = true;
  bool drives = true;  // DriveErrors of the kinds of the set, which integrate recordings
  bool rule = true;    // RuleShifts where recordings are integrated by Euler's rule
};

// A parameter counts as on a bound within 1e-6 of the width of its box. z: all parameters, in their units.
// Evaluates every recording once, and its gradient 2 n times. Throws std::invalid_argument for another number
// of parameters.
Trust assess_trust(const RecordingCosts& costs, const Robot& robot, const ConstVectorRef& z,
                   const TrustOptions& options = {});

}  // namespace odobench
