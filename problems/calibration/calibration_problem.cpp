#include "problems/calibration/calibration_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/angle.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "problems/calibration/robust_form.hpp"
#include "problems/calibration/structure.hpp"

namespace odobench {

struct CalibrationProblem::Structure : CalibrationStructure {
  using CalibrationStructure::CalibrationStructure;
};

namespace {

Vector nominal_values(const std::vector<ParameterInfo>& parameters) {
  Vector z(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = parameters[static_cast<std::size_t>(i)].nominal;
  return z;
}

void check_recordings(const std::vector<Recording>& recordings) {
  if (recordings.empty()) throw std::invalid_argument("calibration: no recordings, expected at least one");
  for (const Recording& r : recordings)
    if (r.size() < 2)
      throw std::invalid_argument(
          fmt::format("calibration: recording '{}' has {} samples, expected at least 2", r.id, r.size()));
}

void check(const std::vector<ParameterInfo>& parameters, const std::vector<Recording>& recordings) {
  if (parameters.size() != static_cast<std::size_t>(kCalibrationParameters))
    throw std::invalid_argument(fmt::format(
        "calibration: {} parameters, expected the 12 of a1..a4, b1..b4, r1..r4", parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string expected = fmt::format("{}{}", "abr"[i / 4], i % 4 + 1);
    if (parameters[i].name != expected)
      throw std::invalid_argument(fmt::format("calibration: parameter {} is '{}', expected '{}'", i + 1,
                                              parameters[i].name, expected));
  }
  validate(parameters);
  for (std::size_t i = 0; i < 4; ++i)
    if (parameters[i].lower <= 0 && parameters[i].upper >= 0 && parameters[i + 4].lower <= 0 &&
        parameters[i + 4].upper >= 0)
      throw std::invalid_argument(
          fmt::format("calibration: the box lets wheel {} stand at the origin (a = b = 0)", i + 1));
  check_recordings(recordings);
}

// The structured form knows one robot, by its class and names, one rule and one cost, and its signals by
// their places: increments, or speeds before angles, are another thing.
bool structured_form_fits(const Robot& robot, const CalibrationOptions& options,
                          const std::vector<Recording>& recordings) {
  const std::vector<Signal> known = recording_4wis4wid().signals;
  for (const Recording& r : recordings)
    if (!std::equal(r.signals.begin(), r.signals.end(), known.begin(), known.end(),
                    [](const Signal& a, const Signal& b) { return a.name == b.name && a.kind == b.kind; }))
      return false;
  if (robot.kinematics != "4wis4wid" || robot.table.rule != TwistRule::Mean || !options.as_in_thesis())
    return false;
  return robot.parameters.size() == static_cast<std::size_t>(kCalibrationParameters);
}

void add_mount(std::vector<ParameterInfo>& parameters) {
  parameters.push_back({"mount_x", "m", 0, -0.25, 0.25});
  parameters.push_back({"mount_y", "m", 0, -0.25, 0.25});
  parameters.push_back({"mount_yaw", "rad", 0, -0.2, 0.2});
}

Eigen::Vector3d pose_error(const PoseTrack& q, const Recording& recording, std::size_t k) {
  return {q.x[k] - recording.reference.x[k], q.y[k] - recording.reference.y[k],
          q.theta[k] - recording.reference.theta[k]};
}

}  // namespace

CalibrationProblem::CalibrationProblem(std::vector<ParameterInfo> parameters,
                                       std::vector<Recording> recordings, InstructionSet kernel)
    : parameters_(std::move(parameters)), recordings_(std::move(recordings)), kernel_(kernel) {
  options_.from_origin = true;
  check(parameters_, recordings_);
  set_rounding_floor();
  structure_ = std::make_unique<Structure>(recordings_, nominal_values(parameters_), kernel_);
}

CalibrationProblem::CalibrationProblem(const Robot& robot, std::vector<Recording> recordings,
                                       const CalibrationOptions& options, InstructionSet kernel)
    : parameters_(robot.parameters), recordings_(std::move(recordings)), options_(options), kernel_(kernel) {
  if (structured_form_fits(robot, options, recordings_)) {
    check(parameters_, recordings_);
    structure_ = std::make_unique<Structure>(recordings_, nominal_values(parameters_), kernel_);
  } else {
    choose_form(robot, options);
  }
  if (options.loss.robust()) robust_ = std::make_unique<RobustForm>(robot, recordings_, options, kernel_);
  set_rounding_floor();
}

void CalibrationProblem::choose_form(const Robot& robot, const CalibrationOptions& options) {
  if (!options.model.any()) {
    if (options.mount) add_mount(parameters_);
    validate(parameters_);
    check_recordings(recordings_);
    general_ =
        std::make_unique<WheeledForm>(robots::WheeledRobot(robot.table), recordings_, options, kernel_);
    return;
  }
  const Robot richer = with_model(robot, options.model);
  parameters_ = richer.parameters;
  for (const RobotParameter& p : parameters_beyond_table(options.model, options.mount))
    parameters_.push_back(p);
  validate(parameters_);
  check_recordings(recordings_);
  robots::WheeledRobot wheels(richer.table);
  // Tables alone have their other forms: linear ones are faster, and know segments.
  CalibrationOptions plain = options;
  if (options.model.anchor) plain.from_origin = false;
  const bool table = !options.model.beyond_table() && (wheels.is_linear() || !ModelForm::serves(options));
  if (table)
    general_ = std::make_unique<WheeledForm>(std::move(wheels), recordings_, plain, kernel_);
  else
    extended_ = std::make_unique<ModelForm>(std::move(wheels), recordings_, plain, kernel_);
}

const std::vector<std::size_t>& CalibrationProblem::rows(std::size_t recording) const {
  if (structure_) throw std::logic_error("the structured form has no list of rows");
  return extended_ ? extended_->rows(recording) : general_->rows(recording);
}

void CalibrationProblem::set_rounding_floor() {
  for (const Recording& r : recordings_)
    for (std::size_t i = 0; i < r.reference.x.size(); ++i) {
      const std::size_t k = r.reference.sample.empty() ? i : r.reference.sample[i];
      exact_floor_ += static_cast<double>(k) *
                      (r.reference.x[i] * r.reference.x[i] + r.reference.y[i] * r.reference.y[i] +
                       r.reference.theta[i] * r.reference.theta[i]);
    }
  constexpr double kUnit = 2 * std::numeric_limits<double>::epsilon();
  exact_floor_ *= kUnit * kUnit * std::max(options_.position_weight, options_.heading_weight);
  if (robust_) exact_floor_ *= robust_->floor_factor();
}

CalibrationProblem::~CalibrationProblem() = default;
CalibrationProblem::CalibrationProblem(CalibrationProblem&&) noexcept = default;
CalibrationProblem& CalibrationProblem::operator=(CalibrationProblem&&) noexcept = default;

double CalibrationProblem::cost(const ConstVectorRef& z) const {
  if (robust_) return robust_->cost(z);
  if (general_) return general_->cost(z);
  if (extended_) return extended_->cost(z);
  return std::max(structure_->cost(z), 0.0);  // not-a-number stays
}

double CalibrationProblem::rounding_floor(const ConstVectorRef& z) const {
  return exact_floor_ + 2 * std::sqrt(exact_floor_ * cost(z));
}

void CalibrationProblem::batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const {
  if (robust_) return robust_->batch_cost(candidates, costs);
  if (!structure_) {
    for (Eigen::Index k = 0; k < candidates.cols(); ++k) costs[k] = cost(candidates.col(k));
    return;
  }
  structure_->batch_cost(candidates, costs);
  for (double& cost : costs) cost = std::max(cost, 0.0);
}

void CalibrationProblem::normal_equations(const ConstVectorRef& z, NormalEquations& out) const {
  if (robust_) return robust_->normal_equations(z, out);
  if (general_) return general_->normal_equations(z, out);
  if (extended_) return extended_->normal_equations(z, out);
  structure_->normal_equations(z, out);
  out.cost = std::max(out.cost, 0.0);
}

Eigen::Index CalibrationProblem::residual_count() const {
  if (general_) return general_->residual_count();
  if (extended_) return extended_->residual_count();
  Eigen::Index count = 0;
  for (const Recording& r : recordings_) count += 3 * (static_cast<Eigen::Index>(r.size()) - 1);
  return count;
}

Eigen::Index CalibrationProblem::residual_count(std::size_t recording) const {
  if (general_) return general_->residual_count(recording);
  if (extended_) return extended_->residual_count(recording);
  return 3 * (static_cast<Eigen::Index>(recordings_.at(recording).size()) - 1);
}

PoseTrack CalibrationProblem::integrate(std::size_t recording, const ConstVectorRef& z) const {
  if (structure_) return direct::integrate(recordings_.at(recording), z);
  const Matrix track = general_ ? general_->track(recording, z) : extended_->track(recording, z);
  PoseTrack q;
  for (Eigen::Index k = 0; k < track.cols(); ++k) {
    q.x.push_back(track(0, k));
    q.y.push_back(track(1, k));
    q.theta.push_back(track(2, k));
  }
  return q;
}

void CalibrationProblem::residuals(const ConstVectorRef& z, VectorRef r) const {
  if (robust_) return robust_->residuals(z, r);
  if (general_) return general_->residuals(z, r);
  if (extended_) return extended_->residuals(z, r);
  Eigen::Index row = 0;
  for (const Recording& recording : recordings_) {
    const PoseTrack q = direct::integrate(recording, z);
    for (std::size_t k = 1; k < recording.size(); ++k, row += 3)
      r.segment<3>(row) = pose_error(q, recording, k);
  }
}

void CalibrationProblem::residuals_and_jacobian(const ConstVectorRef& z, VectorRef r, MatrixRef j) const {
  if (robust_) return robust_->residuals_and_jacobian(z, r, j);
  if (general_) return general_->residuals_and_jacobian(z, r, j);
  if (extended_) return extended_->residuals_and_jacobian(z, r, j);
  structure_->residuals_and_jacobian(recordings_, z, r, j);
}

MaxErrors max_errors(const Recording& recording, const PoseTrack& q) {
  const Reference& reference = recording.reference;
  MaxErrors e{recording.id, recording.trajectory, recording.repetition};
  for (std::size_t entry = 0; entry < reference.x.size(); ++entry) {
    const bool everywhere = reference.sample.empty();
    const std::size_t k = everywhere ? entry : reference.sample[entry];
    const double turned = q.theta[k] - reference.theta[entry];
    e.x = std::max(e.x, std::abs(q.x[k] - reference.x[entry]));
    e.y = std::max(e.y, std::abs(q.y[k] - reference.y[entry]));
    // Headings here and there are known up to turns.
    e.theta = std::max(e.theta, std::abs(everywhere ? turned : wrapped_angle(turned)));
  }
  return e;
}

std::vector<MaxErrors> CalibrationProblem::max_errors(const ConstVectorRef& z) const {
  std::vector<MaxErrors> list;
  for (std::size_t i = 0; i < recordings_.size(); ++i)
    list.push_back(odobench::max_errors(recordings_[i], integrate(i, z)));
  return list;
}

}  // namespace odobench
