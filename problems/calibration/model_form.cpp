#include "problems/calibration/model_form.hpp"

#include "problems/calibration/linear_streams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "base/angle.hpp"
#include "base/range.hpp"
#include "problems/calibration/model_pass.hpp"

namespace odobench {

using Eigen::Index;

namespace {

kernel::ModelField slot_field(WheelField field) {
  switch (field) {
    case WheelField::X:
      return kernel::ModelField::X;
    case WheelField::Y:
      return kernel::ModelField::Y;
    case WheelField::Mount:
    case WheelField::Zero:
      return kernel::ModelField::Heading;
    case WheelField::Gain:
      return kernel::ModelField::Gain;
    case WheelField::Radius:
      return kernel::ModelField::Radius;
    case WheelField::Roller:
      return kernel::ModelField::Roller;
    case WheelField::Offset:
      return kernel::ModelField::Offset;
    case WheelField::Trail:
      return kernel::ModelField::Trail;
  }
  throw std::logic_error("no such field of a wheel");
}

bool is_of_kind(const Recording& recording, const std::string& kind) {
  return !kind.empty() && recording.trajectory.compare(0, kind.size(), kind) == 0;
}

}  // namespace

bool ModelForm::serves(const CalibrationOptions& options) {
  return options.cost != CostKind::Segments && options.rule != robots::IntegrationRule::OptiodomOmni;
}

ModelForm::ModelForm(robots::WheeledRobot robot, const std::vector<Recording>& recordings,
                     const CalibrationOptions& options, InstructionSet kernel)
    : robot_(std::move(robot)),
      options_(options),
      kernel_(kernel::select_model(kernel)),
      signals_(robot_, options.model) {
  if (!serves(options))
    throw std::invalid_argument(
        fmt::format("model '{}': expected every_sample, final_pose or optiodom as cost, and euler, midpoint "
                    "or arc as rule, found {}",
                    options.model.text(), options.text()));
  table_columns_ = static_cast<Index>(robot_.parameters().size());
  columns_ = table_columns_;
  for (const RobotParameter& p : parameters_beyond_table(options.model, options.mount)) {
    const int column = static_cast<int>(columns_++);
    if (p.name == "mount_x") lever_ = column;
    if (p.name == "mount_yaw") yaw_ = column;
    if (p.name == "time_offset") time_ = column;
    if (p.name == "speed_factor") factor_ = column;
  }
  if (robot_.table().wheels.size() > kernel::kMostModelWheels || columns_ > kernel::kMostModelColumns)
    throw std::invalid_argument(fmt::format("model: {} wheels and {} parameters, expected at most {} and {}",
                                            robot_.table().wheels.size(), columns_, kernel::kMostModelWheels,
                                            kernel::kMostModelColumns));
  plan_slots();
  for (const Recording& recording : recordings) {
    read_drive(recording);
    residual_count_ += per_row() * (static_cast<Index>(drives_.back().rows.size()) - 1);
  }
}

// A number of a wheel per slot; mount and zero of a wheel are one, its heading.
void ModelForm::plan_slots() {
  const auto& parameters = robot_.table().parameters;
  std::map<std::pair<int, kernel::ModelField>, std::vector<kernel::ModelTerm>> slots;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    for (const Binding& b : parameters[p].bindings) {
      if (b.field == WheelField::Gain) data_changes_ = true;
      if (parameters[p].parameter.lower == parameters[p].parameter.upper) continue;
      slots[{static_cast<int>(b.wheel), slot_field(b.field)}].push_back({static_cast<int>(p), b.factor});
    }
  }
  data_changes_ = data_changes_ || time_ >= 0;
  slot_terms_.reserve(slots.size());
  for (auto& [key, terms] : slots) {
    slot_terms_.push_back(std::move(terms));
    slots_.push_back(
        {key.first, key.second, slot_terms_.back().data(), static_cast<int>(slot_terms_.back().size())});
  }
}

void ModelForm::read_drive(const Recording& recording) {
  Drive drive;
  drive.raw = signals_.raw(recording);
  drive.of_kind = is_of_kind(recording, options_.model.speed_factor_of);
  drive.steps = (drive.raw.intervals() + kernel_.width - 1) / kernel_.width;
  if (!data_changes_) {
    std::vector<double> gains;
    for (const Wheel& w : robot_.table().wheels) gains.push_back(w.gain);
    drive.data =
        signals_.blocks(drive.raw, options_.model.held_time_offset, gains, drive.steps, kernel_.width);
  }
  choose_rows(recording, drive);
  drives_.push_back(std::move(drive));
}

void ModelForm::choose_rows(const Recording& recording, Drive& drive) const {
  const Reference& reference = recording.reference;
  std::vector<std::size_t> stamps = reference.sample;
  drive.wrapped = !stamps.empty();
  if (stamps.empty())
    for (std::size_t k = 0; k < recording.size(); ++k) stamps.push_back(k);
  drive.start = Eigen::Vector3d::Zero();
  const bool at_start = stamps.front() == 0, anchored = options_.model.anchor || !options_.from_origin;
  if (at_start) {
    drive.start[2] = reference.theta[0];
    if (anchored) drive.start.head<2>() << reference.x[0], reference.y[0];
  }
  if (stamps.back() == 0)
    throw std::invalid_argument(fmt::format("recording '{}' has no reference after its start", recording.id));
  std::vector<std::size_t> entries;
  for (std::size_t i = at_start ? 1 : 0; i < stamps.size(); ++i) entries.push_back(i);
  if (options_.cost == CostKind::FinalPose) entries = {stamps.size() - 1};
  if (options_.cost == CostKind::Optiodom) {
    Vector z(columns_);
    z.setZero();
    z.head(table_columns_) = robot_.nominal();
    if (factor_ >= 0) z[factor_] = 1;
    const Point at = point(z);
    const Pass pass = walk(drive, at);
    std::vector<std::size_t> chosen;
    double travelled = 0;
    std::size_t k = 0;
    for (const std::size_t i : entries) {
      for (; k < stamps[i]; ++k) travelled += pass.travelled(static_cast<Index>(k));
      if (travelled < options_.distance && i + 1 != stamps.size()) continue;
      chosen.push_back(i);
      travelled = 0;
    }
    entries = chosen;
  }
  drive.reference.resize(3, static_cast<Index>(entries.size()) + 1);
  drive.rows = {0};
  drive.reference.col(0) = drive.start;
  drive.row_of.assign(static_cast<std::size_t>(drive.raw.intervals()), -1);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::size_t e = entries[i];
    drive.rows.push_back(stamps[e]);
    drive.row_of[stamps[e] - 1] = static_cast<int>(i) + 1;
    drive.reference.col(static_cast<Index>(i) + 1) << reference.x[e], reference.y[e], reference.theta[e];
  }
}

ModelForm::Point ModelForm::point(const ConstVectorRef& z) const {
  Point at;
  at.usable = z.allFinite() && z.cwiseAbs().maxCoeff() <= kLargestNumber;
  if (!at.usable) return at;
  const Vector own = z.head(table_columns_);
  for (const Wheel& w : wheels_with(robot_.table(), {own.begin(), own.end()})) {
    const bool steered = is_steered(w);
    const double heading = steered ? w.mount + w.zero : w.mount;
    kernel::ModelWheel m{};
    m.x = w.x;
    m.y = w.y;
    m.cos_zero = std::cos(heading);
    m.sin_zero = std::sin(heading);
    m.radius = w.radius;
    m.tangent = std::tan(w.roller);
    m.offset = w.offset;
    m.trail = w.trail;
    m.gain = w.gain;
    m.driven = !w.drive.empty();
    m.slides = w.slides;
    m.cosine_fixed = 1;
    m.sine_fixed = 0;
    at.wheels.push_back(m);
    at.gains.push_back(w.gain);
  }
  signals_.place(at.wheels);
  if (lever_ >= 0) at.lever = z.segment<2>(lever_);
  if (yaw_ >= 0) at.yaw = z[yaw_];
  at.time_offset = time_ >= 0 ? z[time_] : options_.model.held_time_offset;
  if (factor_ >= 0) at.factor = z[factor_];
  return at;
}

ModelForm::Pass ModelForm::walk(const Drive& drive, const Point& at) const {
  Pass pass;
  pass.width = kernel_.width;
  pass.intervals = drive.raw.intervals();
  if (drive.data.empty())
    pass.own_data = signals_.blocks(drive.raw, at.time_offset, at.gains, drive.steps, kernel_.width);
  kernel::ModelTask& task = pass.task;
  task = {};
  task.wheels = at.wheels.data();
  task.wheel_count = static_cast<int>(at.wheels.size());
  task.mean = robot_.table().rule == TwistRule::Mean;
  task.data = drive.data.empty() ? pass.own_data.data() : drive.data.data();
  task.streams = signals_.streams();
  task.steps = drive.steps;
  task.rule = step_rule(options_.rule);
  task.speed_factor = drive.of_kind ? at.factor : 1;
  task.slots = slots_.data();
  task.slot_count = static_cast<int>(slots_.size());
  task.columns = static_cast<int>(columns_);
  task.time_column = time_;
  task.factor_column = drive.of_kind ? factor_ : -1;
  task.lever_x_column = lever_;
  task.lever_y_column = lever_ >= 0 ? lever_ + 1 : -1;
  task.yaw_column = yaw_;
  task.lever_x = at.lever[0];
  task.lever_y = at.lever[1];
  task.heading_weight = heading_weight() / options_.position_weight;
  pass.walk.resize(static_cast<std::size_t>(task.steps * kernel::kWalk * kernel_.width));
  kernel_.walk(task, pass.walk.data());
  if (!pass.turns_little()) {
    task.exact = true;
    kernel_.walk(task, pass.walk.data());
  }
  place_lanes(pass);
  return pass;
}

// Where each lane begins, from the start of the recording.
void ModelForm::place_lanes(Pass& pass) const {
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  for (int lane = 0; lane < pass.width; ++lane) {
    pass.lanes.push_back(pose);
    pose = composed(pose, pass.end(lane));
  }
}

double ModelForm::cost(const ConstVectorRef& z) const {
  const Point at = point(z);
  if (!at.usable) return kNotANumber;
  double sum = 0;
  for (const Drive& drive : drives_) {
    Pass pass = walk(drive, at);
    find_errors(drive, at, free_starts(), pass);
    sum += options_.position_weight * pass.squares;
  }
  return sum;
}

void ModelForm::residuals(const ConstVectorRef& z, VectorRef r) const {
  const Point at = point(z);
  if (!at.usable) {
    r.setConstant(kNotANumber);
    return;
  }
  Index row = 0;
  for (const Drive& drive : drives_) {
    const Index count = per_row() * (static_cast<Index>(drive.rows.size()) - 1);
    Pass pass = walk(drive, at);
    find_errors(drive, at, free_starts(), pass);
    put_residuals(drive, pass, r.segment(row, count));
    row += count;
  }
}

void ModelForm::residuals_and_jacobian(const ConstVectorRef& z, VectorRef r, MatrixRef j) const {
  const Point at = point(z);
  if (!at.usable) {
    r.setConstant(kNotANumber);
    j.setConstant(kNotANumber);
    return;
  }
  Index row = 0;
  for (const Drive& drive : drives_) {
    const Index count = per_row() * (static_cast<Index>(drive.rows.size()) - 1);
    write_rows(drive, at, r.segment(row, count), j.middleRows(row, count));
    row += count;
  }
}

void ModelForm::normal_equations(const ConstVectorRef& z, NormalEquations& out) const {
  const Point at = point(z);
  out.cost = 0;
  out.jtr = Vector::Zero(columns_);
  out.jtj = Matrix::Zero(columns_, columns_);
  if (!at.usable) {
    out.cost = kNotANumber;
    out.jtr.setConstant(kNotANumber);
    out.jtj.setConstant(kNotANumber);
    return;
  }
  for (const Drive& drive : drives_) add_normal(drive, at, out);
}

Matrix ModelForm::track(std::size_t recording, const ConstVectorRef& z) const {
  const Drive& drive = drives_.at(recording);
  const Point at = point(z);
  Matrix track = Matrix::Constant(3, drive.raw.intervals() + 1, kNotANumber);
  if (!at.usable) return track;
  const Pass pass = walk(drive, at);
  const Eigen::Rotation2Dd frame(drive.start[2] - at.yaw);
  track.col(0) = drive.start;
  for (Index k = 0; k < drive.raw.intervals(); ++k) {
    const Eigen::Vector3d pose = pass.tracked(k, at.lever);
    track.col(k + 1).head<2>() = drive.start.head<2>() + frame * pose.head<2>();
    track(2, k + 1) = drive.start[2] + pose[2];
  }
  return track;
}

Eigen::Vector3d ModelForm::start_shift(std::size_t recording, const ConstVectorRef& z) const {
  const Drive& drive = drives_.at(recording);
  const Point at = point(z);
  if (!free_starts() || !at.usable) return Eigen::Vector3d::Zero();
  return fit_start(drive, at, walk(drive, at));
}

}  // namespace odobench
