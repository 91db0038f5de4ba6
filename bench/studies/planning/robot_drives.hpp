// What plan, simulate and verify have in common for a robot of any class or of a user's own wheels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/catalogue/robots.hpp"
#include "bench/studies/parameter_sets.hpp"
#include "problems/simulation/robot_simulator.hpp"

namespace odobench {

// What --parameters and --truth may name: nominal values, those the set knows.
ParameterNames parameter_names(const KnownRobot& known);

// The one set that `source` (name or file) stands for; its values lie inside the robot's box. Throws
// std::invalid_argument where they do not and on a file of several sets.
ParameterSet true_parameters(const KnownRobot& known, const std::string& source, const char* option);

// "b=0.5 (0.25..0.35)" of every value outside the box; "" where there is none.
std::string outside_box(const Robot& robot, const Vector& values);

// Calls with what is wrong told as of the robot: DataError for a file, std::invalid_argument for a class.
class RobotWords {
 public:
  explicit RobotWords(const KnownRobot& known) : known_(known) {}
  template <class Work>
  auto operator()(const Work& work) const {
    try {
      return work();
    } catch (const std::invalid_argument& error) {
      refuse(error.what());
    }
  }

 private:
  [[noreturn]] void refuse(const char* what) const;
  const KnownRobot& known_;
};

// Repetition k of a drive: the same bits alone, among others and on any number of threads.
RobotRun driven(const RobotSimulator& simulator, const RobotDrive& drive, const RobotAbilities& can,
                const Vector& truth, const Vector& believed, std::uint64_t seed, int repetition,
                bool feedback = false);

struct RobotSimulation {
  std::string robot;                // file or class
  std::string parameters;           // the truth: name or file; "": nominal
  std::vector<std::string> drives;  // comma lists of names, or "all"; empty: the standard drives
  int repeat = 3;                   // of each drive
  std::uint64_t seed = 1;
  int threads = 0;
};

// Drives of the robot, commanded by its nominal parameters, as a data set that knows the truth. Throws
// std::invalid_argument on unknown names and too much work, DataError on a bad file.
Dataset simulate_robot(const RobotSimulation& study, Watcher& watcher, const Stop& stop);

}  // namespace odobench
