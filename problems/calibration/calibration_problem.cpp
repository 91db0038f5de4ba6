#include "problems/calibration/calibration_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "datasets/robot_4wis4wid.hpp"
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
  if (recordings.empty()) throw std::invalid_argument("calibration: no recordings, expected at least one");
  for (const Recording& r : recordings)
    if (r.size() < 2)
      throw std::invalid_argument(
          fmt::format("calibration: recording '{}' has {} samples, expected at least 2", r.id, r.size()));
}

Eigen::Vector3d pose_error(const PoseTrack& q, const Recording& recording, std::size_t k) {
  return {q.x[k] - recording.reference.x[k], q.y[k] - recording.reference.y[k],
          q.theta[k] - recording.reference.theta[k]};
}

}  // namespace

CalibrationProblem::CalibrationProblem(std::vector<ParameterInfo> parameters,
                                       std::vector<Recording> recordings, InstructionSet kernel)
    : parameters_(std::move(parameters)), recordings_(std::move(recordings)), kernel_(kernel) {
  check(parameters_, recordings_);
  for (const Recording& r : recordings_)
    for (std::size_t k = 0; k < r.size(); ++k)
      exact_floor_ += static_cast<double>(k) *
                      (r.reference.x[k] * r.reference.x[k] + r.reference.y[k] * r.reference.y[k] +
                       r.reference.theta[k] * r.reference.theta[k]);
  constexpr double kUnit = 2 * std::numeric_limits<double>::epsilon();
  exact_floor_ *= kUnit * kUnit;
  structure_ = std::make_unique<Structure>(recordings_, nominal_values(parameters_), kernel_);
}

CalibrationProblem::~CalibrationProblem() = default;
CalibrationProblem::CalibrationProblem(CalibrationProblem&&) noexcept = default;
CalibrationProblem& CalibrationProblem::operator=(CalibrationProblem&&) noexcept = default;

double CalibrationProblem::cost(const ConstVectorRef& z) const {
  return std::max(structure_->cost(z), 0.0);  // not-a-number stays
}

double CalibrationProblem::rounding_floor(const ConstVectorRef& z) const {
  return exact_floor_ + 2 * std::sqrt(exact_floor_ * cost(z));
}

void CalibrationProblem::batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const {
  structure_->batch_cost(candidates, costs);
  for (double& cost : costs) cost = std::max(cost, 0.0);
}

void CalibrationProblem::normal_equations(const ConstVectorRef& z, NormalEquations& out) const {
  structure_->normal_equations(z, out);
  out.cost = std::max(out.cost, 0.0);
}

Eigen::Index CalibrationProblem::residual_count() const {
  Eigen::Index count = 0;
  for (const Recording& r : recordings_) count += 3 * (static_cast<Eigen::Index>(r.size()) - 1);
  return count;
}

PoseTrack CalibrationProblem::integrate(std::size_t recording, const ConstVectorRef& z) const {
  return direct::integrate(recordings_.at(recording), z);
}

void CalibrationProblem::residuals(const ConstVectorRef& z, VectorRef r) const {
  Eigen::Index row = 0;
  for (const Recording& recording : recordings_) {
    const PoseTrack q = direct::integrate(recording, z);
    for (std::size_t k = 1; k < recording.size(); ++k, row += 3)
      r.segment<3>(row) = pose_error(q, recording, k);
  }
}

void CalibrationProblem::residuals_and_jacobian(const ConstVectorRef& z, VectorRef r, MatrixRef j) const {
  const LinearMatrix chain = linear_jacobian(z);
  Eigen::Index row = 0;
  for (const Recording& recording : recordings_) {
    const PoseTrack q = direct::integrate(recording, z);
    // Derivatives of the pose with respect to the linear parameters (r, P, Q).
    LinearVector gx = LinearVector::Zero(), gy = LinearVector::Zero(), gt = LinearVector::Zero();
    for (std::size_t k = 0; k + 1 < recording.size(); ++k, row += 3) {
      const double dt = static_cast<double>(recording.time_us[k + 1] - recording.time_us[k]) * 1e-6;
      const double cos_theta = std::cos(q.theta[k]), sin_theta = std::sin(q.theta[k]);
      gx -= (q.y[k + 1] - q.y[k]) * gt;
      gy += (q.x[k + 1] - q.x[k]) * gt;
      for (std::size_t i = 0; i < kWheelCount; ++i) {
        const auto w = static_cast<Eigen::Index>(i);
        const double turn = 0.25 * dt * wheel_speed_of(recording, i)[k];
        const double c = turn * std::cos(steering_of(recording, i)[k]),
                     s = turn * std::sin(steering_of(recording, i)[k]);
        gx[w] += cos_theta * c - sin_theta * s;
        gy[w] += sin_theta * c + cos_theta * s;
        gt[4 + w] -= c;
        gt[8 + w] += s;
      }
      r.segment<3>(row) = pose_error(q, recording, k + 1);
      j.row(row) = gx.transpose() * chain;
      j.row(row + 1) = gy.transpose() * chain;
      j.row(row + 2) = gt.transpose() * chain;
    }
  }
}

std::vector<MaxErrors> CalibrationProblem::max_errors(const ConstVectorRef& z) const {
  std::vector<MaxErrors> list;
  for (const Recording& recording : recordings_) {
    const PoseTrack q = direct::integrate(recording, z);
    MaxErrors e{recording.id, recording.trajectory, recording.repetition};
    for (std::size_t k = 0; k < recording.size(); ++k) {
      e.x = std::max(e.x, std::abs(q.x[k] - recording.reference.x[k]));
      e.y = std::max(e.y, std::abs(q.y[k] - recording.reference.y[k]));
      e.theta = std::max(e.theta, std::abs(q.theta[k] - recording.reference.theta[k]));
    }
    list.push_back(std::move(e));
  }
  return list;
}

}  // namespace odobench
