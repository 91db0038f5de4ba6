// J and its derivatives of a table of wheels whose equations are not linear in streams: several segments of a
// recording side by side, one per vector lane.
//
// A block holds `width` segments of one recording, one after the other, each `steps` intervals long:
//     data[(step * streams + stream) * width + lane]
// Of each wheel the streams are its drive (rad), cos and sin of mount + gain * steering, the change of the
// steering over the interval (rad) and, where the time offset is free, the derivatives of drive, steering
// and change by it.
//
// walk() gives motions and poses relative to each segment's start. columns() gives the derivatives of the
// tracked frame's pose seen from there, or their products with each other and with the errors. What a segment
// inherits from those before it is a motion of its start, which enters all of its rows in the same way and is
// put in afterwards (problems/calibration/models/model_form.cpp).
#pragma once

#include "problems/calibration/kernel/kernel.hpp"

namespace odobench::kernel {

inline constexpr int kMostModelWheels = 16;
inline constexpr int kMostModelColumns = 40;

// A wheel at one parameter vector; its streams, -1 where it has none. Fields as in datasets/robots/wheel.hpp.
struct ModelWheel {
  double x, y, cos_zero, sin_zero, radius, tangent, offset, trail, gain;
  bool driven, slides;
  double cosine_fixed, sine_fixed;  // of a wheel that is not steered
  int drive, cosine, sine, change, steering;
  int drive_by, steering_by, change_by;
};

// A number of a wheel that parameters change, and by how much: columns and factors of `terms`.
enum class ModelField { X, Y, Heading, Gain, Radius, Roller, Offset, Trail };
struct ModelTerm {
  int column;
  double factor;
};
struct ModelSlot {
  int wheel;
  ModelField field;
  const ModelTerm* terms;
  int count;
};

struct ModelTask {
  const ModelWheel* wheels;
  int wheel_count;
  bool mean;  // the published mean in place of least squares
  const double* data;
  int streams;
  long steps;
  StepRule rule;
  bool exact;           // steps may turn by more than kMaxAngle
  double speed_factor;  // on the drives
  // For columns() only. Special columns are -1 where there is none.
  const ModelSlot* slots;
  int slot_count, columns;
  int time_column, factor_column, lever_x_column, lever_y_column, yaw_column;
  double lever_x, lever_y;
  double heading_weight;  // relative to that of positions
};

// Of every step, walk[(step * kWalk + entry) * width + lane]: motion in the body frame; cos and sin of the
// heading and the pose after it, from the segment's start.
inline constexpr int kWalk = 8;
enum WalkEntry { kUx, kUy, kTurn, kCos, kSin, kX, kY, kHeadingSum };

// Of every step, errors[(step * kErrors + entry) * width + lane]: error of the tracked frame in the segment's
// frame, of the heading, and 1 where the row counts, 0 where not (errors there are 0).
inline constexpr int kErrors = 4;

// Per column, sums[(column * kColumnSums + entry) * width + lane], (X, Y, T) a row's derivative of the pose:
// X ex + Y ey + w T et, X, Y, T, Y px - X py, X ey - Y ex, p the tracked frame's place in the segment; then
// (X, Y, T) of the body at the end. Behind them the lower triangle of X X' + Y Y' + w T T', row by row.
inline constexpr int kColumnSums = 9;
inline constexpr int model_sums(int columns) {
  return columns * kColumnSums + triangle(columns);
}

struct ModelKernel {
  int width;
  void (*walk)(const ModelTask&, double* walk);
  void (*columns)(const ModelTask&, const double* walk, const double* errors, double* sums);
  // rows[((step * columns + column) * 3 + entry) * width + lane]; sums as above, triangle and products left
  // as they were, to hand over what stands at the end.
  void (*rows)(const ModelTask&, const double* walk, double* rows, double* sums);
};

// Throws std::invalid_argument when the processor does not have it.
ModelKernel select_model(InstructionSet set);

}  // namespace odobench::kernel
