// The input of the relative-entropy filter, row by row, with memory independent of its length. Columns, extra
// ones are passed over:
//   time_s                           s; optional when dt is given
//   enc1_m .. enc4_m                 m, displacement of each wheel along its heading during the step that
//   ends at the row
//   ax_m_s2, ay_m_s2                 m/s^2
//   exactly one rotation, counting as in the file (usually counter-clockwise):
//     yaw_step_deg, yaw_step_rad     during the step;  yaw_rate_deg_s, yaw_rate_rad_s   times dt
//     yaw_deg, yaw_rad               a heading: differenced, the difference taken to (-180, 180] deg; the
//     first row only
//                                    gives the heading that the second one is compared with
//   psi1_deg .. psi4_deg, or _rad    heading of each wheel in the robot; all or none (0)
// A file whose first column is called "Laikas" has the layout of the thesis' program (T. Stirblys, Kaunas
// 2015, Appendix 3): Laikas, enc1 .. enc4, ax, ay, theta, where an option says what theta means.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "datasets/csv/csv_stream.hpp"
#include "datasets/entropy/filter_columns.hpp"

namespace odobench {

// Time, the ten measurements, the four steering angles and the six rotations above: what a mapping may name.
const std::vector<std::string>& filter_run_columns();

struct FilterRunOptions {
  ColumnMapping columns;               // wins over the names in the file and the thesis' layout
  std::string theta = "yaw_step_deg";  // the rotation column that "theta" of the thesis' layout stands for
  bool rotation_as_it_stands = false;  // take whatever the rotation column holds for degrees per step
  bool use_laikas = true;              // as time_s, in the thesis' layout
  // s; without it the first time step where those of the first rows agree within 1 %, else their median.
  std::optional<double> dt;
  // Of a time step against dt, relative; without it 40 %: stamps of arrival jitter.
  std::optional<double> time_tolerance;
  // Where a step is of several dt (up to 10) the rows between are filled in, linearly.
  bool resample = false;
  std::int64_t least_rows = 1;                   // rows that next() must deliver
  const std::atomic<bool>* interrupt = nullptr;  // see CsvStream
};

struct FilterRow {
  double time_s = 0;
  std::array<double, 4> wheel{};     // m
  std::array<double, 4> steering{};  // rad
  double ax = 0, ay = 0;             // m/s^2
  double rotation_deg = 0;           // in the step
  std::size_t line = 0;              // of the file
};

class FilterRunReader {
 public:
  // Opens the file ("-": standard input) and reads its header and the rows that dt needs. Throws DataError
  // with file:line, here and from next(), on a missing or doubled column, a value that is no finite number,
  // times that do not increase or differ from dt by more than the tolerance, fewer than `least_rows` rows, a
  // last line cut off.
  FilterRunReader(const std::filesystem::path& file, const FilterRunOptions& options);

  bool next(FilterRow& row);

  bool thesis_layout() const { return thesis_layout_; }
  bool has_time() const { return time_.has_value(); }
  bool has_steering() const { return steering_.has_value(); }
  double dt() const { return dt_; }
  // Largest |step - dt| that was taken [s], and how many steps were off by more than 1 %.
  double jitter() const { return jitter_; }
  std::int64_t jittered() const { return jittered_; }
  std::int64_t filled() const { return filled_; }  // rows that --resample filled in
  std::int64_t rows() const { return rows_; }      // delivered
  std::int64_t passed_over() const {
    return passed_over_;
  }  // rows before the first one delivered: 1 for headings
  bool interrupted() const { return stream_.interrupted(); }
  // The last line read had all its fields but no line break: its last number may have been cut.
  bool unfinished() const { return stream_.unfinished(); }
  const std::string& file() const { return stream_.file(); }

 private:
  enum class Rotation { Step, Rate, Heading };
  void find_columns();
  void find_rotation(const ColumnFinder& finder);
  void find_steering(const ColumnFinder& finder);
  void find_dt();
  bool read(FilterRow& row);  // rotation as it stands in the file, but in degrees
  bool take(FilterRow& row);  // the same, rows read ahead and filled in first
  void fill_between(const FilterRow& before, const FilterRow& after);
  void check_time(const FilterRow& row);
  [[noreturn]] void too_short(std::int64_t rows) const;

  FilterRunOptions options_;
  CsvStream stream_;
  bool thesis_layout_ = false;
  std::optional<std::size_t> time_;
  std::array<std::size_t, 4> wheel_{};
  std::size_t ax_ = 0, ay_ = 0, rotation_ = 0;
  Rotation rotation_kind_ = Rotation::Step;
  double rotation_unit_ = 1;  // degrees
  std::optional<std::array<std::size_t, 4>> steering_;
  double steering_unit_ = 1;  // radians

  double dt_ = 0;
  double heading_ = 0, last_time_ = 0;
  std::int64_t read_ = 0, rows_ = 0, passed_over_ = 0;
  std::deque<FilterRow> ahead_;  // read to find dt, or filled in
  std::optional<FilterRow> last_row_;
  double jitter_ = 0;
  std::int64_t jittered_ = 0, filled_ = 0;
};

}  // namespace odobench
