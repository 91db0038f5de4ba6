// The two kinds of files of OptiOdom's data: what a robot is, and one of its drives. Errors are DataErrors
// "file:line: ...".
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "datasets/recording.hpp"
#include "datasets/robots/robot.hpp"

namespace odobench::optiodom {

// A sensor's column behind t, x, y, theta.
struct SensorColumn {
  std::string column;  // "n1"
  std::string signal;  // of the robot, "wheel.right"
  SignalKind kind = SignalKind::Increment;
  double sign = 1;  // -1: counts backwards
};

// A type of robot as the data name it.
struct RobotType {
  std::string name;        // "diff"
  std::string kinematics;  // the class of datasets/robots/layouts.hpp
  std::string description;
  std::int64_t step_us = 0;  // between rows
  std::size_t distances = 1, diameters = 1;
  std::vector<SensorColumn> sensors;
};

const std::vector<RobotType>& robot_types();

// STAMP_metadata.csv: rows "name,value,value,...", padded with empty fields.
struct Metadata {
  const RobotType* type = nullptr;
  double counts_per_turn = 1;     // of a wheel: ngear encRes
  std::vector<double> distances;  // m, Li
  std::vector<double> diameters;  // m, Di
  double steering_zero = 0;       // rad, Thi
  std::size_t runs = 0;           // N
  std::optional<double> side;     // m, L: of a square
  bool same_robot(const Metadata& other) const;
};

// Rows type, ngear, encRes, Li, Di, N are needed, each once; Thi and L may be empty; others (marker numbers,
// cuts of the raw files) are passed over. Numbers of distances and diameters are those of the type, all > 0;
// counts of a turn from 1e-3 to 1e12.
Metadata parse_metadata(std::string_view text, const std::string& file);

// The robot with these nominal values and the boxes by default. A mecanum robot's roller angle is held at 45
// degrees.
Robot robot_of(const Metadata& metadata);

// STAMP_run-NN.csv, without a header line: t, x, y, theta and the type's sensors. Wheels become increments in
// rad, sign 2 pi / counts_per_turn of what the file has. Stamps are multiples of the type's step; t may
// differ from them by a quarter of it. `unfinished`: the last line has no line break, so that its last number
// may be cut. `before`: size of the first row's largest increment (rad), which belongs to the time before the
// drive.
struct Run {
  Recording recording;  // without names
  bool unfinished = false;
  double before = 0;
};
Run parse_run(std::string_view text, const std::string& file, const Metadata& metadata);

}  // namespace odobench::optiodom
