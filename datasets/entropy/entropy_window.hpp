// One window of the relative-entropy filter: the constants of its model and N samples of measurements.
// Symbols and units as in T. Stirblys, master's thesis, Kaunas 2015, sections 2.2 and 3.3.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace odobench {

// What a run holds constant. The defaults are those of the thesis' program (its Appendix 3).
struct EntropyConstants {
  int samples = 10;                     // N >= 3, samples in a window
  double dt = 0.1;                      // s, sampling period
  double length = 0.775, width = 0.55;  // m, wheel base and track; only alpha = atan(width / length) is used
  double wheel_distance = 0.475;        // m, L, centre of the robot to a wheel
  double sigma_encoder = 0.01;          // m, of a wheel displacement per step
  double sigma_acceleration = 0.01;     // m/s^2
  double sigma_rotation = 0.01;         // deg, of a rotation per step
  double step_acceleration = 0.0174647286;  // m/s^2, size of one acceleration increment
  double step_rotation = 0.0085554224;      // deg/s^2, size of one angular acceleration increment

  friend bool operator==(const EntropyConstants&, const EntropyConstants&) = default;
};

// Measurements of one sample. Accelerations are in the filter frame, whose x axis goes through wheels 1 and
// 3: the robot frame turned by -alpha. The rotation counts positive when wheels 1 and 2 go forwards, 3 and 4
// backwards.
struct EntropySample {
  std::array<double, 4> wheel{};     // m per step, signed, along the heading of the wheel
  std::array<double, 4> steering{};  // rad, heading of the wheel in the robot frame
  double ax = 0, ay = 0;             // m/s^2
  double rotation = 0;               // deg per step
};

struct EntropyWindow {
  std::string id, group;
  EntropyConstants constants;
  std::vector<EntropySample> samples;  // constants.samples of them
};

}  // namespace odobench
