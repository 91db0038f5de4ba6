#include "problems/simulation/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/angle.hpp"
#include "base/error.hpp"
#include "datasets/robot_4wis4wid.hpp"

namespace odobench::simulate {
namespace {

constexpr std::size_t kMostPhases = 1000;  // every tick looks through them
constexpr double kLongestDrive_s = 86'400, kLongestIdle_s = 3'600, kLongestDelay_s = 60;
constexpr double kFastest = 1000;                       // m/s, rad/s, 1/s and factors of such
constexpr double kNearest = 1e-6, kFarthest_m = 1'000;  // of a wheel from the middle, of its radius
constexpr double kLargestShare =
    0.5;  // of speed lost to slip: beyond that nothing here is a model of a wheel

class Validator {
 public:
  Validator(const RecordingScenario& scenario, const std::string& where) : s_(scenario), where_(where) {}

  void run() const {
    if (s_.name.empty()) fail("name: found an empty text, expected a name");
    if (s_.repetitions < 1) fail(fmt::format("repetitions: found {}, expected at least 1", s_.repetitions));
    check_robot("robot/truth", s_.truth.parameters);
    check_robot("control/believed", s_.control.believed);
    for (const double c : s_.truth.contact_offset)
      if (!(std::abs(c) <= kHalfTrack))
        fail(fmt::format("robot/contact_offset_m: found {}, expected at most {} to either side", c,
                         kHalfTrack));
    positive("robot/steering_limit_deg", s_.truth.steering_limit * 180 / kPi, 360, " deg");
    check_drives();
    check_control();
    check_odometry();
    check_capture();
    check_rest();
    if (s_.exact) check_exact();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw DataError(where_ + ": " + what); }
  // Nothing that a wheeled robot has is beyond `most`: what a typing error makes of a number is told.
  void positive(const char* name, double value, double most, const char* unit) const {
    if (!(value > 0 && value <= most))
      fail(fmt::format("{}: found {}, expected a positive number up to {}{}", name, value, most, unit));
  }
  void not_negative(const char* name, double value, double most, const char* unit) const {
    if (!(value >= 0 && value <= most))
      fail(fmt::format("{}: found {}, expected a number >= 0 up to {}{}", name, value, most, unit));
  }
  void either_side(const char* name, double value, double most, const char* unit) const {
    if (!(std::abs(value) <= most))
      fail(fmt::format("{}: found {}, expected at most {}{} to either side", name, value, most, unit));
  }
  void probability(const char* name, double value) const {
    if (!(value >= 0 && value <= 1)) fail(fmt::format("{}: found {}, expected 0 to 1", name, value));
  }
  void range(const char* name, const Range& r, double most, const char* unit) const {
    if (!(r.low >= 0 && r.low <= r.high && r.high <= most))
      fail(fmt::format("{}: found {} to {}, expected 0 <= first <= second <= {}{}", name, r.low, r.high, most,
                       unit));
  }

  void check_robot(const char* name, const Parameters& z) const {
    for (std::size_t i = 0; i < kWheelCount; ++i) {
      const double a = z[i], b = z[kWheelCount + i], r = z[2 * kWheelCount + i];
      if (!(std::hypot(a, b) >= kNearest && std::hypot(a, b) <= kFarthest_m))
        fail(fmt::format("{}: wheel {} stands at ({}, {}), expected away from the origin, {} to {} m", name,
                         i + 1, a, b, kNearest, kFarthest_m));
      if (!(r >= kNearest && r <= kFarthest_m))
        fail(fmt::format("{}: r{} is {}, expected a positive radius, {} to {} m", name, i + 1, r, kNearest,
                         kFarthest_m));
    }
  }

  void check_drives() const {
    if (s_.drives.empty()) fail("drives: found none, expected at least one");
    std::set<std::string> names;
    for (const Drive& d : s_.drives) {
      if (d.name.empty()) fail("drives: found an empty name, expected one");
      if (!names.insert(d.name).second)
        fail(fmt::format("drives: found '{}' twice, expected every name once", d.name));
      if (d.phases.size() > kMostPhases)
        fail(fmt::format("drive '{}': found {} phases, expected at most {}", d.name, d.phases.size(),
                         kMostPhases));
      if (d.phases.empty()) fail(fmt::format("drive '{}': found no phases, expected at least one", d.name));
      for (std::size_t i = 0; i < kWheelCount; ++i) {
        if (!(d.speed_factor[i] > 0 && d.speed_factor[i] <= kFastest))
          fail(fmt::format("drive '{}': speed_factor is {}, expected positive numbers up to {}", d.name,
                           d.speed_factor[i], kFastest));
        if (!(std::abs(d.steering_offset[i]) <= 2 * kPi))
          fail(fmt::format("drive '{}': a steering offset is {} deg, expected -360 to 360", d.name,
                           d.steering_offset[i] * 180 / kPi));
      }
      for (const Phase& p : d.phases) check_phase(d, p);
    }
  }

  void check_phase(const Drive& d, const Phase& p) const {
    const std::string place = fmt::format("drive '{}'", d.name);
    if (!(p.duration_s > 0 && p.duration_s <= kLongestDrive_s))
      fail(fmt::format("{}: the duration is {} s, expected a positive number up to {} s", place, p.duration_s,
                       kLongestDrive_s));
    for (const double v : {p.twist.vx, p.twist.vy, p.twist.omega})
      if (!(std::abs(v) <= kFastest))
        fail(fmt::format("{}: a velocity is {}, expected at most {} m/s or rad/s to either side", place, v,
                         kFastest));
    const WheelState wheels = d.command(s_.control.believed, p.twist);
    for (std::size_t i = 0; i < kWheelCount; ++i)
      if (std::abs(wheels.steering[i]) > s_.truth.steering_limit + 1e-9)
        fail(fmt::format("{}: unreachable steering: wheel {} needs {:.4g} deg, its limit is {:.4g} deg",
                         place, i + 1, wheels.steering[i] * 180 / kPi, s_.truth.steering_limit * 180 / kPi));
  }

  void check_control() const {
    const Control& c = s_.control;
    not_negative("control/gain_position", c.gain_position, kFastest, " 1/s");
    not_negative("control/gain_heading", c.gain_heading, kFastest, " 1/s");
    not_negative("control/delay_s", c.delay_s, kLongestDelay_s, " s");
    range("control/lead_s", c.lead_s, kLongestDelay_s, " s");
    not_negative("control/wheel_lag_s", c.wheel_lag_s, kLongestDelay_s, " s");
    positive("control/steering_rate_rad_s", c.steering_rate, 1e6, " rad/s");
    not_negative("control/steering_bias_rad", c.steering_bias, kPi, " rad");
    not_negative("control/steering_wander_rad", c.steering_wander, kPi, " rad");
    positive("control/wander_time_s", c.wander_time_s, kLongestDrive_s, " s");
    // A first-order loop with a delay is unstable beyond gain * delay = pi / 2.
    const double product = std::max(c.gain_position, c.gain_heading) * (c.delay_s + 2 * c.wheel_lag_s);
    if (c.closed_loop && product >= kPi / 2)
      fail(fmt::format(
          "control: gain times delay is {:.4g}, expected less than pi/2: the loop would swing up", product));
  }

  void check_odometry() const {
    const Odometry& o = s_.odometry;
    if (!(o.rate_hz >= 5 && o.rate_hz <= 10000))
      fail(fmt::format("odometry/rate_hz: found {}, expected a positive rate, 5 to 10000 Hz", o.rate_hz));
    not_negative("odometry/speed_quantum_rad_s", o.speed_quantum, kFastest, " rad/s");
    not_negative("odometry/steering_quantum_rad", o.steering_quantum, kPi, " rad");
    not_negative("odometry/speed_noise_rad_s", o.speed_noise, kFastest, " rad/s");
    not_negative("odometry/stamp_jitter_s", o.stamp_jitter_s, kLongestDelay_s, " s");
    probability("odometry/on_time", o.on_time);
    not_negative("odometry/on_time_s", o.on_time_s, kLongestDelay_s, " s");
    not_negative("odometry/delay_s", o.delay_s, kLongestDelay_s, " s");
    probability("odometry/stall_probability", o.stall_probability);
    range("odometry/stall_s", o.stall_s, kLongestDelay_s, " s");
  }

  void check_capture() const {
    const Capture& c = s_.capture;
    if (!(c.rate_hz >= 1 && c.rate_hz <= 10000))
      fail(fmt::format("capture/rate_hz: found {}, expected a positive rate, 1 to 10000 Hz", c.rate_hz));
    not_negative("capture/poll_s", c.poll_s, kLongestDelay_s, " s");
    not_negative("capture/delay_s", c.delay_s, kLongestDelay_s, " s");
    probability("capture/stall_probability", c.stall_probability);
    range("capture/stall_s", c.stall_s, kLongestDelay_s, " s");
    range("capture/loss", c.loss, 0.9, "");
    not_negative("capture/position_noise_m", c.position_noise, kFarthest_m, " m");
    not_negative("capture/heading_noise_rad", c.heading_noise, 2 * kPi, " rad");
  }

  void check_rest() const {
    range("idle/before_s", s_.idle.before_s, kLongestIdle_s, " s");
    range("idle/after_s", s_.idle.after_s, kLongestIdle_s, " s");
    not_negative("start/position_m", s_.start.position, kFarthest_m, " m");
    not_negative("start/heading_rad", s_.start.heading, 2 * kPi, " rad");
    not_negative("slip/fixed", s_.slip.fixed, kLargestShare, "");
    not_negative("slip/random", s_.slip.random, kLargestShare, "");
    either_side("slip/yaw_bias_rad_s", s_.slip.yaw_bias, kFastest, " rad/s");
    for (const auto& [name, gains] : s_.slip.gains) {
      const auto same = [&drive = name](const Drive& d) { return d.name == drive; };
      if (std::none_of(s_.drives.begin(), s_.drives.end(), same))
        fail(fmt::format("slip/gains: found '{}', expected the name of a drive", name));
      positive("slip/gains", gains.linear, kFastest, "");
      positive("slip/gains", gains.angular, kFastest, "");
    }
  }

  void check_exact() const {
    const auto contradict = [this](bool given, const char* what) {
      if (given) fail(fmt::format("contradictory options: exact together with {}", what));
    };
    contradict(s_.control.closed_loop, "control/mode closed_loop; an exact drive has constant commands");
    contradict(s_.slip.fixed > 0 || s_.slip.random > 0 || s_.slip.yaw_bias != 0 || !s_.slip.gains.empty(),
               "slip");
  }

  const RecordingScenario& s_;
  const std::string& where_;
};

}  // namespace

Parameters nominal_parameters(const Robot& robot) {
  Parameters z{};
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = robot.parameters.at(i).nominal;
  return z;
}

RecordingScenario default_scenario() {
  RecordingScenario s;
  s.robot = robot_4wis4wid();
  s.truth.parameters = s.control.believed = nominal_parameters(s.robot);
  s.drives = reference_drives();
  return s;
}

double most_samples(const RecordingScenario& s, const Drive& drive) {
  const double idle = s.exact ? 0 : s.idle.before_s.high + s.idle.after_s.high;
  return (drive.duration() + idle) * (s.odometry.rate_hz + (s.exact ? 0 : s.capture.rate_hz));
}

double most_samples(const RecordingScenario& s) {
  double sum = 0;
  for (const Drive& drive : s.drives) sum += s.repetitions * most_samples(s, drive);
  return sum;
}

void validate(const RecordingScenario& scenario, const std::string& where) {
  Validator(scenario, where).run();
}

}  // namespace odobench::simulate
