// Intervals of numbers that somebody makes of parameters, and how far J may rise along a single one.
#pragma once

#include <vector>

#include "problems/information/formula.hpp"
#include "problems/trust/intervals.hpp"
#include "problems/trust/twist_map.hpp"

namespace odobench {

// A formula of parameters and of the numbers of the twist map (r1, m11), at z.
struct CombinationInterval {
  Formula formula;
  std::string unit;  // "" of a number, or where sums of different units leave none
  double nominal = 0, value = 0;
  // Whether it is made of the numbers of the map alone, to first order: its gradient lies in their span (a
  // rest below 1e-6 of its length).
  bool of_the_map = false;
  Interval interval;  // in the unit
};

// By linearisation, c the gradient of the formula in q:
// - of the map: what stands for the map's own numbers, the moves of the free parameters (LeaveOneOut);
// - else CR3 with Satterthwaite's degrees of freedom over all parameters, only while no bound is active and
//   where the half width is at most that of the box, sum |c_j| w_j: as single parameters have it.
// Throws std::invalid_argument as evaluate() does, and for another number of parameters.
std::vector<CombinationInterval> combination_intervals(const RecordingCosts& costs, const Robot& robot,
                                                       const ConstVectorRef& z,
                                                       const std::vector<Formula>& formulas);

// The value of a formula at z alone; what it is refused for, it is refused for here.
Quantity formula_at(const Formula& formula, const Robot& robot, const std::vector<ParameterInfo>& parameters,
                    const ConstVectorRef& z);

// How far J may rise along one parameter before its 95 % interval ends: with the parameter j free beside
// those on no bound, v_j and nu of LeaveOneOut and the same curvature Hx,
//     rise = t_.975(nu)^2 v_j / [Hx^-1]_jj,
// so that of a quadratic J the values with J_p <= J* + rise are those within the half width t sqrt(v_j).
struct RiseAlong {
  Eigen::Index parameter = 0;  // place in the problem's list
  double rise = 0;             // not-a-number where there is no interval
  double half_width = 0;       // t sqrt(v_j) in the parameter's unit, the same
  NoInterval refused = NoInterval::None;
  std::string reason;
};
// Of every parameter whose bounds differ.
std::vector<RiseAlong> rises_along(const RecordingCosts& costs, const ConstVectorRef& z);

}  // namespace odobench
