#include <algorithm>
#include <string>

#include "base/angle.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "problems/simulation/scenario.hpp"

namespace odobench::simulate {
namespace {

constexpr double kTurn = 2 * kPi;
constexpr double kToe = 25 * kPi / 180;  // rad
constexpr double kFaster = 1.3;

// The lines with one wheel turned aside or faster than the others.
void add_fighting(std::vector<Drive>& drives) {
  const Drive line_x = drives[0], line_y = drives[1];
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    const std::string wheel = std::to_string(i + 1);
    Drive toe_x = line_x, toe_y = line_y, fast_x = line_x;
    toe_x.name = "toe_x_" + wheel;
    toe_x.description = "line_x with wheel " + wheel + " turned by 25 degrees";
    toe_x.steering_offset[i] = kToe;
    toe_y.name = "toe_y_" + wheel;
    toe_y.description = "line_y with wheel " + wheel + " turned back by 25 degrees";
    toe_y.steering_offset[i] = -kToe;
    fast_x.name = "fast_x_" + wheel;
    fast_x.description = "line_x with wheel " + wheel + " 30 % faster";
    fast_x.speed_factor[i] = kFaster;
    for (Drive* drive : {&toe_x, &toe_y, &fast_x}) drives.push_back(std::move(*drive));
  }
}

}  // namespace

WheelState Drive::command(const Parameters& believed, const Twist& twist, const PerWheel& held) const {
  WheelState w = inverse_kinematics(believed, twist, held);
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    w.steering[i] += steering_offset[i];
    w.speed[i] *= speed_factor[i];
  }
  return w;
}

double Drive::duration() const {
  double sum = 0;
  for (const Phase& phase : phases) sum += phase.duration_s;
  return sum;
}

Pose Drive::reference(double t) const {
  Pose pose;
  for (const Phase& phase : phases) {
    const double part = std::clamp(t, 0.0, phase.duration_s);
    pose = moved(pose, phase.twist, part);
    t -= phase.duration_s;
    if (t <= 0) break;
  }
  return pose;
}

Twist Drive::reference_twist(double t) const {
  for (const Phase& phase : phases) {
    if (t < phase.duration_s) return phase.twist;
    t -= phase.duration_s;
  }
  return {};
}

std::vector<Drive> reference_drives() {
  const std::vector<Trajectory> names = trajectories_4wis4wid();
  constexpr double speed = 0.05, slow = kTurn / 80, fast = kTurn / 40, radius = 0.5;
  const Phase phases[] = {{{speed, 0, 0}, 80},
                          {{0, speed, 0}, 80},
                          {{radius * slow, 0, slow}, 80},
                          {{radius * slow, 0, -slow}, 80},
                          {{0, 0, fast}, 40},
                          {{0, 0, -fast}, 40}};
  std::vector<Drive> drives;
  for (std::size_t i = 0; i < names.size(); ++i)
    drives.push_back({names[i].name, names[i].description, {phases[i]}, {}, {1, 1, 1, 1}});
  return drives;
}

std::vector<Drive> known_drives() {
  std::vector<Drive> drives = reference_drives();
  constexpr double v = 0.05, w = kTurn / 80, diagonal = 0.0353553390593274;
  const auto add = [&drives](const char* name, const char* text, std::vector<Phase> phases) {
    drives.push_back({name, text, std::move(phases), {}, {1, 1, 1, 1}});
  };
  add("diagonal_left", "straight line of 4 m, 45 degrees to the left", {{{diagonal, diagonal, 0}, 80}});
  add("diagonal_right", "straight line of 4 m, 45 degrees to the right", {{{diagonal, -diagonal, 0}, 80}});
  add("crab_ccw", "one circle of radius 0.5 m driven sideways, counter-clockwise", {{{0, 0.5 * w, w}, 80}});
  add("crab_cw", "one circle of radius 0.5 m driven sideways, clockwise", {{{0, 0.5 * w, -w}, 80}});
  add("tight_ccw", "two circles of radius 0.2 m, counter-clockwise", {{{0.4 * w, 0, 2 * w}, 80}});
  add("tight_cw", "two circles of radius 0.2 m, clockwise", {{{0.4 * w, 0, -2 * w}, 80}});
  // The turning centre near a wheel: that wheel hardly moves, the others show the rest.
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    const double x = (i == 0 || i == 3 ? 1 : -1) * kHalfTrack, y = (i < 2 ? 1 : -1) * kHalfTrack;
    constexpr double omega = kTurn / 60;
    add(i == 0   ? "pivot_1"
        : i == 1 ? "pivot_2"
        : i == 2 ? "pivot_3"
                 : "pivot_4",
        "two turns about a point near that wheel", {{{0.8 * y * omega, -0.8 * x * omega, omega}, 120}});
  }
  add("eight", "figure of eight of two circles of radius 0.4 m",
      {{{0.4 * w * 2, 0, 2 * w}, 40}, {{0.4 * w * 2, 0, -2 * w}, 40}});
  std::vector<Phase> weave;
  for (int k = 0; k < 8; ++k) weave.push_back({{v, k % 2 == 0 ? 0.03 : -0.03, k % 4 < 2 ? w : -w}, 10});
  add("weave", "eight pieces ahead, swerving and turning to either side", weave);
  add_fighting(drives);
  return drives;
}

}  // namespace odobench::simulate
