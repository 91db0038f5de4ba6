// Ordinary differential equations by Boost.Odeint: the classic Runge-Kutta method with fixed steps, and the
// Dormand-Prince pair 5(4) with step control.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <stdexcept>
#include <string>

namespace odobench::dynamics {

enum class Method {
  RungeKutta4,    // fixed steps
  DormandPrince,  // adaptive
};

struct IntegrationOptions {
  // The current's time constant of 2.6 ms needs short steps after every jump of a voltage, and none later: with fixed
  // steps of 1 ms the first samples are off by 2e-4 A.
  Method method = Method::DormandPrince;
  double step_s = 1e-3;  // of RungeKutta4 (made to divide each piece evenly); first step of DormandPrince
  double relative_tolerance = 1e-10;  // of DormandPrince, per step
  double absolute_tolerance = 1e-12;

  // Throws std::invalid_argument naming field, value and limit.
  void validate() const {
    const auto require = [](bool holds, const char* field, double value, const char* expected) {
      if (!holds)
        throw std::invalid_argument(
            fmt::format("integration: {} is {}, expected {}", field, value, expected));
    };
    require(step_s > 0 && std::isfinite(step_s), "step_s", step_s, "a positive number");
    require(relative_tolerance > 0 && relative_tolerance < 1, "relative_tolerance", relative_tolerance,
            "between 0 and 1");
    require(absolute_tolerance > 0 && std::isfinite(absolute_tolerance), "absolute_tolerance",
            absolute_tolerance, "a positive number");
  }
};

// Moves `state` (std::array of doubles) from time `from` to `to` > from under system(state, rates, time), whose right
// side must be smooth in between: breakpoints belong to the caller. Throws std::runtime_error when the state does not
// stay finite or no step is small enough.
template <class State, class System>
void advance(State& state, const System& system, double from, double to, const IntegrationOptions& options) {
  namespace odeint = boost::numeric::odeint;
  if (options.method == Method::RungeKutta4) {
    const auto steps = std::max(1L, std::lround((to - from) / options.step_s));
    const double step = (to - from) / static_cast<double>(steps);
    odeint::runge_kutta4<State> stepper;
    for (long k = 0; k < steps; ++k)
      stepper.do_step(system, state, from + static_cast<double>(k) * step, step);
  } else {
    try {
      odeint::integrate_adaptive(
          odeint::make_controlled(options.absolute_tolerance, options.relative_tolerance,
                                  odeint::runge_kutta_dopri5<State>()),
          system, state, from, to, std::min(options.step_s, to - from));
    } catch (const odeint::odeint_error& error) {
      throw std::runtime_error(fmt::format("integration from {} s: {}", from, error.what()));
    }
  }
  for (const double value : state)
    if (!std::isfinite(value))
      throw std::runtime_error(
          fmt::format("integration: the state is not finite at {} s; the step may be too long", to));
}

}  // namespace odobench::dynamics
