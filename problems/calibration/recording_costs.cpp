#include "problems/calibration/recording_costs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace odobench {

using Eigen::Index;

RecordingCosts::RecordingCosts(const Robot& robot, std::span<const Recording> recordings,
                               const CalibrationOptions& options, InstructionSet kernel) {
  if (recordings.empty()) throw std::invalid_argument("calibration: no recordings, expected at least one");
  problems_.reserve(recordings.size());
  for (const Recording& recording : recordings)
    problems_.emplace_back(robot, std::vector<Recording>{recording}, options, kernel);
}

Vector RecordingCosts::costs(const ConstVectorRef& z) const {
  Vector costs(static_cast<Index>(size()));
  for (std::size_t n = 0; n < size(); ++n) costs[static_cast<Index>(n)] = problems_[n].cost(z);
  return costs;
}

std::vector<NormalEquations> RecordingCosts::normal_equations(const ConstVectorRef& z) const {
  std::vector<NormalEquations> list(size());
  for (std::size_t n = 0; n < size(); ++n) problems_[n].normal_equations(z, list[n]);
  return list;
}

WeightedCalibration::WeightedCalibration(std::shared_ptr<const RecordingCosts> recordings, Vector weights)
    : recordings_(std::move(recordings)), weights_(std::move(weights)) {
  const auto count = static_cast<Index>(recordings_->size());
  if (weights_.size() != count)
    throw std::invalid_argument(
        fmt::format("calibration: {} weights for {} recordings", weights_.size(), count));
  if (!weights_.allFinite() || (weights_.array() < 0).any() || (weights_.array() <= 0).all())
    throw std::invalid_argument(
        "calibration: weights of recordings must be finite and not negative, and one of them positive");
}

double WeightedCalibration::cost(const ConstVectorRef& z) const {
  double sum = 0;
  for (Index n = 0; n < weights_.size(); ++n)
    if (weights_[n] > 0) sum += weights_[n] * (*recordings_)[static_cast<std::size_t>(n)].cost(z);
  return sum;
}

void WeightedCalibration::normal_equations(const ConstVectorRef& z, NormalEquations& out) const {
  const Index n = z.size();
  out.cost = 0;
  out.jtr = Vector::Zero(n);
  out.jtj = Matrix::Zero(n, n);
  NormalEquations part;
  for (Index i = 0; i < weights_.size(); ++i) {
    if (weights_[i] == 0) continue;
    (*recordings_)[static_cast<std::size_t>(i)].normal_equations(z, part);
    out.cost += weights_[i] * part.cost;
    out.jtr += weights_[i] * part.jtr;
    out.jtj += weights_[i] * part.jtj;
  }
}

void WeightedCalibration::batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const {
  costs.setZero();
  Vector part(candidates.cols());
  for (Index n = 0; n < weights_.size(); ++n) {
    if (weights_[n] == 0) continue;
    (*recordings_)[static_cast<std::size_t>(n)].batch_cost(candidates, part);
    costs += weights_[n] * part;
  }
}

double WeightedCalibration::rounding_floor(const ConstVectorRef& z) const {
  double sum = 0;
  for (Index n = 0; n < weights_.size(); ++n)
    if (weights_[n] > 0) sum += weights_[n] * (*recordings_)[static_cast<std::size_t>(n)].rounding_floor(z);
  return sum;
}

}  // namespace odobench
