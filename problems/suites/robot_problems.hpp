// Calibrations of simulated robots as test problems: robots:CLASS for every class of robots. The set is
// that of make_robot_demo (problems/simulation/robot_demo.hpp) with the instance as its seed: its standard
// drives, once each, with noise, and true parameters that are known.
//
// J, its box and its Jacobian are those of CalibrationProblem with the class' usual options; the start are
// the nominal parameters. known_optimum() is the lowest J that Gauss-Newton steps from the truth reach, and
// known_minimisers() where. Neither is given where a step leaves the box.
#pragma once

#include <string>
#include <vector>

#include "problems/classic/classic_problems.hpp"
#include "problems/instruction_set.hpp"

namespace odobench {

inline constexpr int kRobotInstances = 1000;

std::vector<ClassicEntry> robot_problem_entries();
// `name` of robot_problem_entries(), an instance in 1..kRobotInstances. Throws std::invalid_argument on
// anything else.
Problem make_robot_problem(const std::string& name, int instance, InstructionSet kernel);

}  // namespace odobench
