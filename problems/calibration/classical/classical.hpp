// Classical calibrations of wheeled robots: closed forms and small linear systems from prescribed drives, the
// methods to which an optimiser is compared. docs/classical_methods.md has the equations and their sources.
//
// Every method takes a robot with nominal values and recordings of its wheels (increments or speeds) with a
// reference. Poses are relative to a recording's first reference; without one at the first stamp to the
// origin. A recording turns clockwise or counter-clockwise where its odometry with nominal values turns by
// more than a quarter turn. Nothing random; nothing is changed.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/recording.hpp"
#include "datasets/robots/robot.hpp"
#include "problems/matrices.hpp"
#include "problems/robots/integration.hpp"

namespace odobench::classical {

struct Options {
  double side = 0;        // of the square, m; 0: a quarter of the path by odometry
  double distance = 0.5;  // between sample rows by nominal values, m (methods that cut drives into pieces)
  std::size_t least_runs = 2;  // of squares, in each sense
  bool nominal_track = false;  // squares: the nominal track where the method has the calibrated one
  // Of the odometry that squares and straight lines are compared by; other methods have their own.
  robots::IntegrationRule rule = robots::IntegrationRule::Midpoint;
};

// An intermediate value of a method.
struct Figure {
  std::string name;  // "alpha"
  std::string unit;  // "rad", "m", "1"
  double value = 0;
};

struct Result {
  Vector z;       // of the robot, in the order of its parameters; empty where the method finds a matrix
  Matrix matrix;  // of lin: 3 x wheels, twists (m, m, rad) by wheel paths (m) at nominal radii; else empty
  Vector mount;   // of censi_mount: x, y (m), yaw (rad) of the sensor in the body frame; else empty
  std::vector<Figure> figures;
  // Throws std::out_of_range for a name that is not there.
  double figure(std::string_view name) const;
};

struct Method {
  std::string name;                  // "umbmark"
  std::vector<std::string> classes;  // of datasets/robots/layouts.hpp
  std::string description;           // one line: what it asks for and finds
  // "" where it applies, else one line that says what is missing, without the method's name.
  std::function<std::string(const Robot&, const std::vector<Recording>&, const Options&)> why_not;
  // Throws std::invalid_argument "METHOD: REASON" where why_not() has one, and where the equations have no
  // solution.
  std::function<Result(const Robot&, const std::vector<Recording>&, const Options&)> run;
};

// Poses by a matrix of twists by wheel paths (Result::matrix), of every recording 3 x samples, from the first
// reference as the problem's odometry is, integrated by `rule`. Throws std::invalid_argument for a matrix
// that does not fit the robot's wheels.
std::vector<Matrix> tracks_by_matrix(const Matrix& matrix, const Robot& robot,
                                     const std::vector<Recording>& recordings, robots::IntegrationRule rule);

// In the order of the documentation. A new method is a row in classical.cpp.
const std::vector<Method>& methods();
// Throws std::invalid_argument for an unknown name, with the nearest one.
const Method& method(std::string_view name);

}  // namespace odobench::classical
