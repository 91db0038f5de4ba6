// What `bench filter` was asked for, with every place decided where the thesis' program differs from its own
// text, and the conversion of file rows to samples of the filter. docs/entropy_filter.md explains the choices
// (E2, E3, E8, E9, E11).
#pragma once

#include "bench/catalogue/option_values.hpp"
#include "datasets/entropy/entropy_window.hpp"
#include "datasets/entropy/filter_run.hpp"
#include "datasets/entropy/filter_truth.hpp"
#include "datasets/logs/log_file.hpp"
#include "problems/entropy/entropy_model.hpp"
#include "problems/instruction_set.hpp"
#include "solvers/run.hpp"

namespace odobench {

// Where the thesis' program and the corrected filter differ; what is not set follows
// EntropyOptions::as_published.
struct EntropyOptions {
  std::string data;                   // CSV file, "-" for standard input; with a map logs, a comma list
  std::string map;                    // of logs: which fields are wheels, gyro.z, accel.x, accel.y
  LogOptions log;                     // of such logs
  std::string truth;                  // CSV file; empty: none
  std::string solver = "coordinate";  // coordinate, exact, relaxed, zero, or any of the registry as typed
  std::string out;                    // CSV file, "-" for standard output; empty: none
  std::vector<std::string> columns, truth_columns;  // name=column lists as typed
  bool as_published = false;
  std::optional<std::string> theta;                // of the thesis' layout: step-deg, ..., raw
  std::optional<std::string> accelerometer_frame;  // robot | filter
  std::optional<bool> omega_cross_v;
  std::optional<std::string> wheel_order;  // right-first | left-first
  std::optional<double> dt;                // s; none: from time_s
  std::optional<double> time_tolerance;    // relative; none: as FilterRunOptions has it
  bool resample = false;                   // fill in rows that are missing
  EntropyConstants constants;              // dt and step_rotation apart
  std::optional<double> step_rotation;     // deg/s^2
  bool gap = false;                        // compare with exact and relaxed
  bool compare_kalman = false;             // with a linear filter and smoother; needs truth
  std::optional<InstructionSet> kernel;
  std::uint64_t seed = 1;
  Budget budget{kDefaultMaxEvaluations};  // per window, of a solver of the registry
  bool overwrite = false;                 // what `out` finds
  bool checksum = false;                  // of the data for the record; reads them once more
};

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
FilterSetup make_filter_setup(const EntropyOptions& options);

// A row as the filter takes it, and the displacements of its wheels in the filter's frame [m].
struct ConvertedRow {
  EntropySample sample;
  std::array<double, 4> x{}, y{};
};

// The truth in the model's sense of rotation, with the wheels predicted by (2.24)-(2.27) where the file has
// none.
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
