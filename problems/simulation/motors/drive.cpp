#include "problems/simulation/motors/drive.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"

namespace odobench::dynamics {
namespace {

constexpr double kLongestDrive_s = 86'400, kHighestVoltage = 1'000;
// How far the steps of DormandPrince reach on y' = -lambda y, lambda times the step.
constexpr double kStableReach = 3.3;
// Two times closer than this are the same.
constexpr double kTimeSlack = 1e-9;

void check_segment(const Segment& segment, std::size_t index, double begin) {
  const auto fail = [index](const std::string& what) {
    throw std::invalid_argument(fmt::format("segment {}: {}", index + 1, what));
  };
  if (!std::isfinite(segment.until_s) || segment.until_s <= begin)
    fail(fmt::format("until_s is {}, expected more than {} (a duration above 0)", segment.until_s, begin));
  if (segment.until_s > kLongestDrive_s)
    fail(fmt::format("until_s is {}, expected at most {} s", segment.until_s, kLongestDrive_s));
  for (std::size_t i = 0; i < kWheels; ++i) {
    if (!(std::abs(segment.voltage[i]) <= kHighestVoltage))
      fail(fmt::format("the voltage of wheel {} is {}, expected a finite number of -{} to {} V", i + 1,
                       segment.voltage[i], kHighestVoltage, kHighestVoltage));
    if (!(std::abs(segment.steering[i]) <= kPi / 2 + 1e-12))
      fail(fmt::format("the steering of wheel {} is {:.6g} deg, expected -90 to 90: a wheel turns no further",
                       i + 1, segment.steering[i] * 180 / kPi));
  }
}

// The electrical time constant is by far the shortest; however smooth the motion is, no step is much longer.
void check_stiffness(const DriveSetup& setup) {
  const MotorParameters& m = setup.robot.motor;
  const double steps = setup.segments.back().until_s * m.resistance / m.inductance / kStableReach;
  if (setup.integration.method == Method::DormandPrince && steps > static_cast<double>(kMostSteps))
    throw std::invalid_argument(fmt::format(
        "inductance is {} H, with a resistance of {} ohm the time constant of the current is {:.3g} s and a "
        "drive of {} s takes {:.2g} steps, expected at most {}",
        m.inductance, m.resistance, m.inductance / m.resistance, setup.segments.back().until_s, steps,
        kMostSteps));
}

}  // namespace

void DriveSetup::validate() const {
  dynamics::validate(robot);
  model.validate();
  integration.validate();
  if (segments.empty()) throw std::invalid_argument("segments: found none, expected at least one");
  double begin = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    check_segment(segments[i], i, begin);
    begin = segments[i].until_s;
  }
  check_stiffness(*this);
}

Inputs inputs_at(const std::vector<Segment>& segments, std::size_t index, double t) {
  const Segment& now = segments[index];
  if (!now.ramp) return {now.voltage, now.steering};
  const double begin = index > 0 ? segments[index - 1].until_s : 0;
  const double part = (t - begin) / (now.until_s - begin);
  Inputs in;
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double u = index > 0 ? segments[index - 1].voltage[i] : 0;
    const double xi = index > 0 ? segments[index - 1].steering[i] : 0;
    in.voltage[i] = u + (now.voltage[i] - u) * part;
    in.steering[i] = xi + (now.steering[i] - xi) * part;
  }
  return in;
}

void check_size(const DriveSetup& setup, double step_s) {
  if (!(step_s > 0) || !std::isfinite(step_s))
    throw std::invalid_argument(fmt::format("output_step_s is {}, expected a positive number", step_s));
  const double end = setup.segments.back().until_s;
  if (end / step_s > static_cast<double>(kMostSamples))
    throw std::invalid_argument(
        fmt::format("output_step_s is {}, a drive of {} s makes {:.3g} samples, expected at most {}", step_s,
                    end, end / step_s, kMostSamples));
  const double steps = end / setup.integration.step_s;
  if (setup.integration.method == Method::RungeKutta4 && steps > static_cast<double>(kMostSteps))
    throw std::invalid_argument(
        fmt::format("integration: step_s is {}, a drive of {} s takes {:.3g} steps, expected at most {}",
                    setup.integration.step_s, end, steps, kMostSteps));
}

std::vector<Sample> simulate_drive(const DriveSetup& setup, double step_s) {
  setup.validate();
  check_size(setup, step_s);
  State state{};
  StepCount count;
  std::vector<Sample> samples;
  std::size_t segment = 0;
  const auto record = [&](double t) {
    const Inputs in = inputs_at(setup.segments, segment, t);
    samples.push_back({t, in, state, rates(setup.robot, setup.model, in, state)});
  };
  record(0);
  double t = 0;
  const double end = setup.segments.back().until_s;
  for (std::size_t k = 1; static_cast<double>(k) * step_s <= end + kTimeSlack; ++k) {
    const double target = static_cast<double>(k) * step_s;
    while (target - t > kTimeSlack) {
      if (setup.segments[segment].until_s - t <= kTimeSlack && segment + 1 < setup.segments.size()) ++segment;
      const double until = setup.segments[segment].until_s;
      // A breakpoint within the slack of an output counts as there: no step of 1e-16 s.
      const double stop = until < target - kTimeSlack ? until : target;
      advance(
          state,
          [&](const State& s, State& d, double at) {
            d = rates(setup.robot, setup.model, inputs_at(setup.segments, segment, at), s);
          },
          t, stop, setup.integration, count);
      t = stop;
    }
    record(target);
  }
  return samples;
}

std::vector<std::string> experiment_names() {
  return {"exp1_steered", "exp2_circle", "exp3_arc_then_straight", "filter_run"};
}

std::vector<Segment> experiment(const std::string& name) {
  constexpr double base = 6, more = 9, angle = kPi / 6;
  if (name == "exp1_steered") return {{50, {base, base, base, base}, {-angle, angle, angle, -angle}, false}};
  if (name == "exp2_circle") return {{50, {base, base, more, more}, {}, false}};
  if (name == "exp3_arc_then_straight")
    return {{20, {base, base, more, more}, {}, false}, {50, {base, base, base, base}, {}, false}};
  if (name == "filter_run")
    return {{20, {base, base, base + kHintVoltageStep, base + kHintVoltageStep}, {}, false}};
  throw std::invalid_argument(fmt::format(
      "found the experiment '{}', expected exp1_steered, exp2_circle, exp3_arc_then_straight or filter_run",
      name));
}

}  // namespace odobench::dynamics
