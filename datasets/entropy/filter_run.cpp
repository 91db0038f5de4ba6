#include "datasets/entropy/filter_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace odobench {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

constexpr std::int64_t kRowsForPeriod = 21;    // at most; a window's rows are waited for anyway
constexpr double kEven = 0.01, kJitter = 0.4;  // of the period
constexpr double kMostFilled = 11;             // periods from row to row

std::string numbered(const char* stem, int number, const char* unit) {
  return fmt::format("{}{}_{}", stem, number, unit);
}

const std::vector<std::string>& rotation_names() {
  static const std::vector<std::string> names = {"yaw_step_deg",   "yaw_step_rad", "yaw_rate_deg_s",
                                                 "yaw_rate_rad_s", "yaw_deg",      "yaw_rad"};
  return names;
}

// What the thesis' program calls the columns, where the mapping says nothing else.
void add_thesis_names(FilterRunOptions& options) {
  const auto stands_for = [&](const std::string& canonical, const std::string& name) {
    options.columns.try_emplace(canonical, name);
  };
  stands_for("time_s", options.use_laikas ? "Laikas" : kNoColumn);
  for (int i = 1; i <= 4; ++i) stands_for(numbered("enc", i, "m"), fmt::format("enc{}", i));
  stands_for("ax_m_s2", "ax");
  stands_for("ay_m_s2", "ay");
  for (const std::string& name : rotation_names())
    if (options.columns.count(name) != 0) return;
  stands_for(options.theta, "theta");
}

}  // namespace

const std::vector<std::string>& filter_run_columns() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list = {"time_s", "enc1_m", "enc2_m", "enc3_m", "enc4_m", "ax_m_s2", "ay_m_s2"};
    list.insert(list.end(), rotation_names().begin(), rotation_names().end());
    for (const char* unit : {"deg", "rad"})
      for (int i = 1; i <= 4; ++i) list.push_back(numbered("psi", i, unit));
    return list;
  }();
  return names;
}

FilterRunReader::FilterRunReader(const std::filesystem::path& file, const FilterRunOptions& options)
    : options_(options), stream_(file, ',', options.interrupt) {
  if (stream_.interrupted()) return;
  thesis_layout_ = stream_.name(0) == "Laikas";
  if (thesis_layout_) add_thesis_names(options_);
  find_columns();
  find_dt();
  if (interrupted()) return;
  if (rotation_kind_ != Rotation::Heading) return;
  FilterRow first;
  if (!take(first)) {
    if (interrupted()) return;
    too_short(0);
  }
  heading_ = first.rotation_deg;
  passed_over_ = 1;
}

void FilterRunReader::find_columns() {
  const ColumnFinder finder(stream_, options_.columns, filter_run_columns());
  time_ = finder.find("time_s");
  if (!time_ && !options_.dt) {
    stream_.fail("found no column \"time_s\" and no sampling period, expected one of them");
  }
  for (int i = 0; i < 4; ++i) wheel_[i] = finder.require(numbered("enc", i + 1, "m"));
  ax_ = finder.require("ax_m_s2");
  ay_ = finder.require("ay_m_s2");
  find_rotation(finder);
  find_steering(finder);
}

void FilterRunReader::find_rotation(const ColumnFinder& finder) {
  std::vector<std::string> found;
  for (const bool mapped : {true, false}) {  // a mapped column makes the others extra ones
    for (const std::string& name : rotation_names())
      if ((options_.columns.count(name) != 0) == mapped && finder.find(name)) found.push_back(name);
    if (!found.empty()) break;
  }
  if (found.size() != 1) {
    std::string list;
    for (const std::string& name : found) list += (list.empty() ? "\"" : ", \"") + name + "\"";
    std::string all;
    for (const std::string& name : rotation_names()) all += (all.empty() ? "" : ", ") + name;
    stream_.fail(fmt::format("found {}, expected exactly one of {}",
                             found.empty() ? "no rotation column" : "the rotation columns " + list, all));
  }
  const std::string& name = found.front();
  rotation_ = *finder.find(name);
  if (options_.rotation_as_it_stands) return;
  const bool rate = name.rfind("yaw_rate_", 0) == 0, step = name.rfind("yaw_step_", 0) == 0;
  rotation_kind_ = rate ? Rotation::Rate : step ? Rotation::Step : Rotation::Heading;
  rotation_unit_ = name.find("rad") != std::string::npos ? kDegreesPerRadian : 1;
}

void FilterRunReader::find_steering(const ColumnFinder& finder) {
  for (const char* unit : {"deg", "rad"}) {
    std::array<std::size_t, 4> columns{};
    std::string missing, there;
    for (int i = 0; i < 4; ++i) {
      const std::string name = numbered("psi", i + 1, unit);
      const auto column = finder.find(name);
      if (column) columns[i] = *column;
      std::string& list = column ? there : missing;
      if (list.empty()) list = name;
    }
    if (there.empty()) continue;
    if (!missing.empty())
      stream_.fail(fmt::format("found \"{}\" but no column \"{}\", expected all four steering angles or none",
                               there, missing));
    if (steering_) stream_.fail("found steering angles in degrees and in radians, expected one of them");
    steering_ = columns;
    steering_unit_ = std::string_view(unit) == "deg" ? 1 / kDegreesPerRadian : 1;
  }
}

void FilterRunReader::find_dt() {
  if (options_.dt) {
    dt_ = *options_.dt;
    return;
  }
  std::vector<double> steps;
  const auto wanted =
      static_cast<std::size_t>(std::clamp<std::int64_t>(options_.least_rows, 2, kRowsForPeriod));
  for (FilterRow row; ahead_.size() < wanted && read(row);) {
    if (!ahead_.empty()) steps.push_back(row.time_s - ahead_.back().time_s);
    ahead_.push_back(row);
  }
  if (interrupted()) return;
  if (steps.empty()) too_short(static_cast<std::int64_t>(ahead_.size()));
  dt_ = steps.front();
  const auto off = [this](double step) { return std::abs(step - dt_) > kEven * dt_; };
  if (!options_.time_tolerance && std::any_of(steps.begin(), steps.end(), off)) {
    std::vector<double> sorted = steps;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                     sorted.end());
    dt_ = sorted[sorted.size() / 2];
  }
  std::deque<FilterRow> rows;
  rows.swap(ahead_);
  last_time_ = rows.front().time_s;
  for (const FilterRow& row : rows) {
    if (!ahead_.empty()) check_time(row);
    if (options_.resample && last_row_) fill_between(*last_row_, row);
    last_row_ = row;
    last_time_ = row.time_s;
    ahead_.push_back(row);
  }
}

void FilterRunReader::too_short(std::int64_t rows) const {
  if (rotation_kind_ == Rotation::Heading)
    stream_.fail(
        fmt::format("found the end of the file after {} rows, expected at least {} (a window and the heading "
                    "before it)",
                    rows, options_.least_rows + 1));
  stream_.fail(fmt::format("found the end of the file after {} rows, expected at least {} (a window)", rows,
                           options_.least_rows));
}

void FilterRunReader::check_time(const FilterRow& row) {
  const double step = row.time_s - last_time_;
  if (!(step > 0))
    stream_.fail_at(row.line, fmt::format("found the time {} s after {} s, expected it to increase",
                                          row.time_s, last_time_));
  if (!(dt_ > 0)) return;  // not yet known
  const double whole = options_.resample ? std::max(1.0, std::round(step / dt_)) : 1;
  // Times of long runs are written with few digits after the point.
  const double rounding = 1e-12 * std::abs(row.time_s), error = std::abs(step - whole * dt_);
  if (error > kEven * dt_ + rounding) {
    ++jittered_;
    jitter_ = std::max(jitter_, error);
  }
  if (error <= options_.time_tolerance.value_or(kJitter) * dt_ + rounding && whole <= kMostFilled) return;
  stream_.fail_at(row.line, fmt::format("found a time step of {:.9g} s, expected {:.9g} s within {:g} %{}; "
                                        "--time-tolerance and --dt state them",
                                        step, dt_, 100 * options_.time_tolerance.value_or(kJitter),
                                        !options_.resample && step > dt_
                                            ? ": where rows are missing --resample fills them in"
                                            : ""));
}

void FilterRunReader::fill_between(const FilterRow& before, const FilterRow& after) {
  const auto missing = static_cast<int>(std::round((after.time_s - before.time_s) / dt_)) - 1;
  for (int k = 1; k <= missing; ++k) {
    const double share = static_cast<double>(k) / (missing + 1);
    const auto between = [share](double a, double b) { return a + share * (b - a); };
    FilterRow row = before;
    row.line = after.line;
    row.time_s = between(before.time_s, after.time_s);
    for (std::size_t w = 0; w < 4; ++w) {
      row.wheel[w] = between(before.wheel[w], after.wheel[w]);
      row.steering[w] = between(before.steering[w], after.steering[w]);
    }
    row.ax = between(before.ax, after.ax);
    row.ay = between(before.ay, after.ay);
    const double turn = rotation_kind_ == Rotation::Heading
                            ? std::remainder(after.rotation_deg - before.rotation_deg, 360.0)
                            : after.rotation_deg - before.rotation_deg;
    row.rotation_deg = before.rotation_deg + share * turn;
    ahead_.push_back(row);
    ++filled_;
  }
}

bool FilterRunReader::read(FilterRow& row) {
  if (!stream_.next()) return false;
  row.line = stream_.line();
  if (time_) {
    row.time_s = stream_.number(*time_);
    if (read_ > 0) check_time(row);
    last_time_ = row.time_s;
  }
  for (int i = 0; i < 4; ++i) row.wheel[i] = stream_.number(wheel_[i]);
  row.ax = stream_.number(ax_);
  row.ay = stream_.number(ay_);
  row.rotation_deg = rotation_unit_ * stream_.number(rotation_);
  if (steering_)
    for (int i = 0; i < 4; ++i) row.steering[i] = steering_unit_ * stream_.number((*steering_)[i]);
  ++read_;
  return true;
}

bool FilterRunReader::take(FilterRow& row) {
  if (ahead_.empty()) {
    FilterRow next;
    if (!read(next)) return false;
    if (options_.resample && last_row_) fill_between(*last_row_, next);
    last_row_ = next;
    ahead_.push_back(next);
  }
  row = ahead_.front();
  ahead_.pop_front();
  return true;
}

bool FilterRunReader::next(FilterRow& row) {
  if (interrupted()) return false;
  if (!take(row)) {
    if (!interrupted() && rows_ < options_.least_rows) too_short(read_);
    return false;
  }
  if (rotation_kind_ == Rotation::Rate) row.rotation_deg *= dt_;
  if (rotation_kind_ == Rotation::Heading) {
    const double heading = row.rotation_deg;
    row.rotation_deg = std::remainder(heading - heading_, 360.0);
    heading_ = heading;
  }
  ++rows_;
  return true;
}

}  // namespace odobench
