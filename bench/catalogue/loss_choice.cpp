#include "bench/catalogue/loss_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <stdexcept>

#include "base/error.hpp"
#include "base/text.hpp"
#include "problems/trust/error_scales.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

constexpr int kRounds = 8;

Vector solution(const std::shared_ptr<const CalibrationProblem>& model, const Vector& start) {
  const Problem problem(model);
  const Result result = solve(problem, {"lm", {}}, start.size() > 0 ? start : problem.start(), {});
  if (!result.usable() || !std::isfinite(result.cost))
    throw std::invalid_argument("no least-squares solution from nominal parameters: " + result.message);
  return result.x;
}

double weight_of(double scale, const char* what) {
  if (!(scale > 0))
    throw std::invalid_argument(fmt::format(
        "--weights=auto: half of the {} errors are 0, nothing to estimate from; give --weights=P,H", what));
  return four_digits(1 / (scale * scale));
}

void estimate_scales(const CalibrationProblem& squared, const Vector& z, Loss& loss) {
  if (loss.scope == LossScope::Recording) {
    loss.position_scale = four_digits(recording_scale(squared, z));
  } else {
    const ErrorScales scales = error_scales(squared, z);
    loss.position_scale = four_digits(scales.position);
    // Without headings in the cost any scale does.
    loss.heading_scale = squared.options().cost == CostKind::Optiodom ? 1 : four_digits(scales.heading);
  }
  if (!(loss.position_scale > 0) || (loss.scope == LossScope::Sample && !(loss.heading_scale > 0)))
    throw std::invalid_argument(fmt::format(
        "--loss={}: half of the errors are 0, no scale to estimate from; give --loss-scale", loss.name()));
}

}  // namespace

void require_consistent(const CalibrationChoice& choice) {
  const bool robust = choice.loss.robust(), sample = choice.loss.scope == LossScope::Sample;
  const std::size_t given = choice.loss_scale.size();
  if (given > 0 && !robust)
    throw std::invalid_argument("--loss-scale: contradictory options: the squared loss has no scale");
  if (given > 0 && given != (sample ? 2U : 1U))
    throw std::invalid_argument(
        fmt::format("--loss-scale: found {} number{}, expected {}", given, given == 1 ? "" : "s",
                    sample ? "two, position (m) and heading (rad), of a loss per sample"
                           : "one of a loss per recording"));
  const bool weighted = choice.estimate_weights || choice.position_weight != 1 || choice.heading_weight != 1;
  if (robust && sample && weighted)
    throw std::invalid_argument(
        "--weights: contradictory options: a loss per sample weighs by --loss-scale instead");
  const CostKind cost = choice.cost.value_or(CostKind::EverySample);
  if ((choice.piece_seconds > 0 || choice.piece_metres > 0) && cost != CostKind::Segments &&
      cost != CostKind::Optiodom)
    throw std::invalid_argument(
        "--piece: contradictory options: only --cost=segments and optiodom have pieces");
}

LossStart fit_loss(const Robot& robot, const std::vector<Recording>& recordings, CalibrationOptions& options,
                   const CalibrationChoice& choice, InstructionSet kernel) {
  if (!choice.loss.robust() && !choice.estimate_weights) return {};
  const auto model = [&] {
    return std::make_shared<const CalibrationProblem>(robot, recordings, options, kernel);
  };
  auto squared = model();
  Vector z = solution(squared, {});
  for (int round = 0; choice.estimate_weights && round < kRounds; ++round) {
    const ErrorScales scales = error_scales(*squared, z);
    const double position = weight_of(scales.position, "position"),
                 heading = options.cost == CostKind::Optiodom ? 1 : weight_of(scales.heading, "heading");
    if (position == options.position_weight && heading == options.heading_weight) break;
    options.position_weight = position;
    options.heading_weight = heading;
    squared = model();
    z = solution(squared, z);
  }
  if (!choice.loss.robust()) return {};
  options.loss = choice.loss;
  Loss& loss = options.loss;
  if (choice.loss_scale.empty()) {
    estimate_scales(*squared, z, loss);
  } else {
    loss.position_scale = choice.loss_scale[0];
    if (choice.loss_scale.size() > 1) loss.heading_scale = choice.loss_scale[1];
  }
  if (loss.kind != LossKind::Tukey) return {"squared", z};
  const Loss tukey = loss;
  loss.kind = LossKind::Cauchy;
  loss.tuning = usual_tuning(loss.kind, loss.scope);
  z = solution(model(), z);
  loss = tukey;
  return {"cauchy", z};
}

std::vector<std::string> unlike_siblings(const std::vector<Recording>& recordings, const Screening& found) {
  std::vector<std::string> said;
  for (const std::size_t n : found.set_aside())
    said.push_back(fmt::format("{} differs from its siblings ({:.3g} times the usual)",
                               printable(recordings[n].id), found.scores[n].z));
  for (const std::string& kind : found.undecided)
    said.push_back(
        fmt::format("{}: half of the repetitions or more differ from the others: none of them can be told to "
                    "be the wrong one",
                    printable(kind)));
  return said;
}

LeftOut leave_out(const Robot& robot, std::vector<Recording>& recordings, const CalibrationOptions& options,
                  const CalibrationChoice& choice) {
  LeftOut out;
  if (!(choice.screen > 0)) return out;
  const Screening found = screen_siblings(robot, recordings, options, choice.screen);
  out.said = unlike_siblings(recordings, found);
  const std::vector<std::size_t> places = found.set_aside();
  for (std::size_t i = 0; i < places.size(); ++i) {
    out.said[i] += ": left out";
    out.recordings.push_back({std::move(recordings[places[i]]), places[i], found.scores[places[i]].z});
  }
  for (std::size_t i = places.size(); i-- > 0;)
    recordings.erase(recordings.begin() + static_cast<std::ptrdiff_t>(places[i]));
  return out;
}

}  // namespace odobench
