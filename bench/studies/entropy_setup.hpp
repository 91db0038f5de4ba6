// What `bench filter` was asked for, with every place decided where the thesis' program differs from its own text, and
// the conversion of file rows to samples of the filter. docs/entropy_filter.md explains the choices (E2, E3, E8, E9, E11).
#pragma once

#include "bench/verbs/command_options.hpp"
#include "datasets/entropy/entropy_window.hpp"
#include "datasets/entropy/filter_run.hpp"
#include "datasets/entropy/filter_truth.hpp"
#include "problems/entropy/entropy_model.hpp"

namespace odobench {

struct FilterSetup {
  EntropyConstants constants;      // dt is that of the data once they are opened
  bool turn_accelerations = true;  // given in the robot's frame: turned by alpha into the filter's
  bool omega_cross_v = true;       // the filter's acceleration is a - omega x v
  double rotation_sign = 1;        // of the model's rotation against counter-clockwise
  std::int64_t rows_unused = 0;    // at the end of the data
  FilterRunOptions reader;         // without its interruption flag
  ColumnMapping truth_columns;
};

// Throws std::invalid_argument on values that do not exist, constants out of range, columns nobody knows.
FilterSetup make_filter_setup(const FilterOptions& options);

// A row as the filter takes it, and the displacements of its wheels in the filter's frame [m].
struct ConvertedRow {
  EntropySample sample;
  std::array<double, 4> x{}, y{};
};

// The truth in the model's sense of rotation, with the wheels predicted by (2.24)-(2.27) where the file has none.
struct TrueSample {
  double sx = 0, sy = 0, ax = 0, ay = 0, rotation = 0;
  std::array<double, 4> x{}, y{};
};

class SampleConverter {
 public:
  explicit SampleConverter(const FilterSetup& setup);

  // Frame, sign and, with omega_cross_v, the acceleration of the turning frame's components,
  //     d(vx)/dt = ax + omega vy,   d(vy)/dt = ay - omega vx,
  // with v from the mean wheel displacement and omega from the measured rotation of the same row.
  const ConvertedRow& convert(const FilterRow& row);
  TrueSample convert(const FilterTruth& truth) const;

 private:
  FilterSetup setup_;
  Predictor predictor_;
  double alpha_, cos_alpha_, sin_alpha_;
  std::array<double, 4> steering_{}, cos_{}, sin_{};  // of the steering angles last seen, turned by alpha
  ConvertedRow row_;
};

}  // namespace odobench
