// What the filter of `bench fuse` believes of the wheels.
#pragma once

#include <string>

#include "bench/catalogue/problem_factory.hpp"
#include "problems/fusion/sensors_file.hpp"

namespace odobench {

// The values of --odometry-noise:
//   file      as the sensors' file says; DataError where it says nothing
//   measured  the noise that the drives show with these parameters (problems/trust/odometry_noise.hpp)
//   total     the same with what repeats in every repetition, for which the filter has no state
//   V,W       standard deviations of one sample, m/s and rad/s
struct WheelNoiseChoice {
  enum class Kind { File, Measured, Total, Values } kind = Kind::File;
  double velocity = 0, yaw_rate = 0;
};
// "": the file's where it has "wheels", else the total. Throws std::invalid_argument on anything else.
WheelNoiseChoice wheel_noise_choice(const std::string& text, const SensorsFile& sensors);

// Sets the filter's options for these parameters, and returns what that is, a sentence. sigma_velocity and
// sigma_yaw_rate become those of a sample at the drives' typical speed. Throws DataError where the drives
// tell nothing.
std::string believe_wheels(const WheelNoiseChoice& choice, const LoadedProblem& loaded, const Vector& z,
                           const std::string& label, SensorsFile& sensors);

}  // namespace odobench
