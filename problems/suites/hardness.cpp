#include "problems/suites/hardness.hpp"

#include <map>
#include <string_view>

namespace odobench {
namespace {

const std::map<std::string_view, const char*>& lines() {
  static const std::map<std::string_view, const char*> table{
      {"sphere", "nothing: how fast a method gets the last digits"},
      {"ellipsoid", "condition 1e6, turned against the axes"},
      {"corner", "the optimum lies on bounds, across a turned valley"},
      {"rosenbrock", "a bent valley"},
      {"powell", "a singular Jacobian at the minimum"},
      {"rastrigin", "some 10^n local minima"},
      {"step", "plateaus: no derivatives"},
      {"nist:Misra1a", "level lower: two parameters of unlike scale"},
      {"nist:Misra1b", "level lower: two parameters of unlike scale"},
      {"nist:Misra1c", "level average: two parameters of unlike scale"},
      {"nist:Misra1d", "level average: two parameters of unlike scale"},
      {"nist:Chwirut1", "level lower: large residuals"},
      {"nist:Chwirut2", "level lower: large residuals"},
      {"nist:Lanczos1", "level average: three exponentials, residuals of rounding"},
      {"nist:Lanczos2", "level average: three exponentials of like rates"},
      {"nist:Lanczos3", "level lower: three exponentials of like rates"},
      {"nist:Gauss1", "level lower: two separate peaks"},
      {"nist:Gauss2", "level lower: two peaks that touch"},
      {"nist:Gauss3", "level average: two peaks that overlap"},
      {"nist:DanWood", "level lower: a power"},
      {"nist:Kirby2", "level average: a rational function, scales from 1 to 1e-5"},
      {"nist:Hahn1", "level average: a rational function, scales from 1 to 1e-7"},
      {"nist:Nelson", "level average: a rate inside an exponent"},
      {"nist:MGH17", "level average: two exponentials of nearly one rate"},
      {"nist:Roszman1", "level average: an arc tangent with a pole"},
      {"nist:ENSO", "level average: two unknown periods, many local minima"},
      {"nist:MGH09", "level higher: a valley to infinity"},
      {"nist:Thurber", "level higher: a rational function of steep change"},
      {"nist:BoxBOD", "level higher: a plateau beside the minimum"},
      {"nist:Rat42", "level higher: a sigmoid of few points"},
      {"nist:MGH10", "level higher: scales from 1e-3 to 1e4, a long exponential valley"},
      {"nist:Eckerle4", "level higher: a peak that far starts do not see"},
      {"nist:Rat43", "level higher: a sigmoid with a free power"},
      {"nist:Bennett5", "level higher: a long flat valley"},
      {"mgh:rosenbrock", "a bent valley"},
      {"mgh:freudenstein-roth", "a second minimum at the end of a valley"},
      {"mgh:powell-badly-scaled", "scales from 1e-5 to 10 along a hyperbola"},
      {"mgh:brown-badly-scaled", "scales from 1e-6 to 1e6"},
      {"mgh:beale", "a saddle, valleys to infinity"},
      {"mgh:jennrich-sampson", "large residuals, plateaus"},
      {"mgh:helical-valley", "a helical valley with a jump of the angle"},
      {"mgh:bard", "poles, a valley to infinity"},
      {"mgh:gaussian", "plateaus away from the peak"},
      {"mgh:meyer", "scales from 1e-3 to 1e4, a long exponential valley"},
      {"mgh:gulf", "plateaus"},
      {"mgh:box-3d", "lines of equal cost"},
      {"mgh:powell-singular", "a singular Jacobian at the minimum"},
      {"mgh:wood", "a saddle where methods rest, two bent valleys"},
      {"mgh:kowalik-osborne", "poles, a valley to infinity"},
      {"mgh:brown-dennis", "large residuals"},
      {"mgh:osborne-1", "two exponentials of nearly one rate"},
      {"mgh:biggs-exp6", "exchangeable exponentials, a second minimum"},
      {"mgh:osborne-2", "an exponential and three peaks, local minima"},
      {"mgh:watson", "nearly dependent parameters"},
      {"mgh:extended-rosenbrock", "bent valleys, one per pair"},
      {"mgh:extended-powell-singular", "a singular Jacobian at the minimum"},
      {"mgh:penalty-1", "a sphere of nearly equal cost"},
      {"mgh:penalty-2", "a sphere of nearly equal cost, unlike scales"},
      {"mgh:variably-dimensioned", "a fourth power along one direction"},
      {"mgh:trigonometric", "local minima"},
      {"mgh:brown-almost-linear", "a product beside linear equations, a second minimum"},
      {"mgh:discrete-boundary-value", "little: stiff neighbours"},
      {"mgh:discrete-integral-equation", "little: a dense Jacobian"},
      {"mgh:broyden-tridiagonal", "little: local minima far away"},
      {"mgh:broyden-banded", "little: cubic growth far away"},
      {"mgh:linear-full-rank", "nothing: a linear problem"},
      {"mgh:linear-rank-1", "a space of minima, badly scaled"},
      {"mgh:linear-rank-1-zero", "a space of minima, parameters without effect"},
      {"mgh:chebyquad", "permutations of the nodes, local minima"}};
  return table;
}

}  // namespace

std::string what_is_hard(const ClassicEntry& entry) {
  if (!entry.hard.empty()) return entry.hard;
  const std::size_t slash = entry.name.rfind('/');
  const auto found = lines().find(std::string_view(entry.name).substr(0, slash));
  if (found == lines().end()) return "";
  std::string text = found->second;
  if (slash == std::string::npos) return text;
  const std::string start = entry.name.substr(slash + 1);
  if (entry.family == "nist") return text + (start == "1" ? "; begins far away" : "");
  return text + "; begins " + start + " times as far";
}

}  // namespace odobench
