#include "datasets/entropy/filter_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace odobench {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

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
  for (FilterRow& row : ahead_)
    if (!read(row)) {
      if (interrupted()) return;
      too_short(&row - ahead_.data());
    }
  ahead_count_ = 2;
  dt_ = ahead_[1].time_s - ahead_[0].time_s;
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

void FilterRunReader::check_time(double time) {
  const double step = time - last_time_;
  if (!(step > 0))
    stream_.fail(fmt::format("found the time {} s after {} s, expected it to increase", time, last_time_));
  // dt_ is 0 until the second row says what it is. Times of long runs are written with few digits after the
  // point.
  const double rounding = 1e-12 * std::abs(time);
  if (dt_ > 0 && std::abs(step - dt_) > options_.time_tolerance * dt_ + rounding)
    stream_.fail(fmt::format("found a time step of {:.9g} s, expected {:.9g} s within {:g} %", step, dt_,
                             100 * options_.time_tolerance));
}

bool FilterRunReader::read(FilterRow& row) {
  if (!stream_.next()) return false;
  row.line = stream_.line();
  if (time_) {
    row.time_s = stream_.number(*time_);
    if (read_ > 0) check_time(row.time_s);
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
  if (ahead_used_ == ahead_count_) return read(row);
  row = ahead_[ahead_used_++];
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
