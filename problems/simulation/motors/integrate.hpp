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
#include <cstdint>
#include <stdexcept>
#include <string>

namespace odobench::dynamics {

enum class Method {
  RungeKutta4,    // fixed steps
  DormandPrince,  // adaptive
};

struct IntegrationOptions {
  // The current's time constant of 2.6 ms needs short steps after every jump of a voltage, and none later:
  // with fixed steps of 1 ms the first samples are off by 2e-4 A.
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
    require(step_s >= 1e-9 && step_s <= 3600, "step_s", step_s, "a positive number of 1e-9 to 3600 s");
    require(relative_tolerance >= 1e-14 && relative_tolerance < 1, "relative_tolerance", relative_tolerance,
            "between 0 and 1, at least 1e-14");
    require(absolute_tolerance >= 1e-30 && absolute_tolerance <= 1e6, "absolute_tolerance",
            absolute_tolerance, "a positive number of 1e-30 to 1e6");
  }
};

// Steps that one simulation may take; what needs more would run for hours. Measured: a microsecond each with
// fixed steps, two with step control.
inline constexpr std::int64_t kMostSteps = 100'000'000;

// Counts steps over the pieces of a simulation.
class StepCount {
 public:
  // Throws std::runtime_error that names the time `at`, s, when there are more than kMostSteps.
  void add_one(double at) {
    if (++count_ > kMostSteps)
      throw std::runtime_error(fmt::format(
          "integration: {} steps reach {:.6g} s only, expected no more for the whole drive; voltages, robot "
          "parameters or tolerances ask for steps that are too short",
          kMostSteps, at));
  }

 private:
  std::int64_t count_ = 0;
};

// Moves `state` (std::array of doubles) from time `from` to `to` > from under system(state, rates, time),
// whose right side must be smooth in between: breakpoints belong to the caller. Throws std::runtime_error
// when the state does not stay finite, no step is small enough, or there are too many.
template <class State, class System>
void advance(State& state, const System& system, double from, double to, const IntegrationOptions& options,
             StepCount& count) {
  namespace odeint = boost::numeric::odeint;
  if (options.method == Method::RungeKutta4) {
    const auto steps = std::max(1L, std::lround((to - from) / options.step_s));
    const double step = (to - from) / static_cast<double>(steps);
    odeint::runge_kutta4<State> stepper;
    for (long k = 0; k < steps; ++k) {
      count.add_one(from + static_cast<double>(k) * step);
      stepper.do_step(system, state, from + static_cast<double>(k) * step, step);
    }
  } else {
    try {
      odeint::integrate_adaptive(
          odeint::make_controlled(options.absolute_tolerance, options.relative_tolerance,
                                  odeint::runge_kutta_dopri5<State>()),
          system, state, from, to, std::min(options.step_s, to - from),
          [&count](const State& reached, double at) {
            count.add_one(at);
            if (!std::isfinite(reached[0])) throw odeint::odeint_error("the state is not finite");
          });
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
