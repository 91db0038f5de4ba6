// A calibration recording by recording: J(z) = sum_n w_n J_n(z) with the costs J_n of single recordings.
//
// What validation, bootstrap, screening and intervals need: sums over some recordings, or over recordings
// that count more than once, without preparing them again. Every J_n is evaluated by the form that
// CalibrationProblem chooses for it, so J_n summed with weights 1 is that problem's J to rounding.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "problems/calibration/calibration_problem.hpp"

namespace odobench {

// Immutable; every member may be called from several threads.
class RecordingCosts {
 public:
  // Throws as CalibrationProblem does.
  RecordingCosts(const Robot& robot, std::span<const Recording> recordings, const CalibrationOptions& options,
                 InstructionSet kernel = widest_instruction_set());

  std::size_t size() const { return problems_.size(); }
  const std::vector<ParameterInfo>& parameters() const { return problems_.front().parameters(); }
  // The problem of recording n alone.
  const CalibrationProblem& operator[](std::size_t n) const { return problems_.at(n); }
  const Recording& recording(std::size_t n) const { return problems_.at(n).recordings().front(); }

  // J_n(z).
  Vector costs(const ConstVectorRef& z) const;
  // J_n, J_n'r_n and J_n'J_n: score and information of every recording.
  std::vector<NormalEquations> normal_equations(const ConstVectorRef& z) const;

 private:
  std::vector<CalibrationProblem> problems_;
};

// sum_n w_n J_n as a problem of its own. Weights: one per recording, none negative, one at least positive;
// counts of a bootstrap, 0 and 1 of a fold. Recordings of weight 0 are not evaluated.
class WeightedCalibration {
 public:
  // Throws std::invalid_argument for other weights.
  WeightedCalibration(std::shared_ptr<const RecordingCosts> recordings, Vector weights);

  std::string name() const { return "calibration"; }
  const std::vector<ParameterInfo>& parameters() const { return recordings_->parameters(); }
  const Vector& weights() const { return weights_; }
  double cost(const ConstVectorRef& z) const;
  void normal_equations(const ConstVectorRef& z, NormalEquations& out) const;
  void batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const;
  double rounding_floor(const ConstVectorRef& z) const;

 private:
  std::shared_ptr<const RecordingCosts> recordings_;
  Vector weights_;
};

}  // namespace odobench
