#include "bench/studies/importing/heading_reference.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "problems/calibration/wheeled_form.hpp"

namespace odobench {
namespace {

using Eigen::Index;

void hold_a_radius(Dataset& dataset) {
  for (BoundParameter& bound : dataset.robot.table.parameters) {
    RobotParameter& p = bound.parameter;
    const bool radius = std::any_of(bound.bindings.begin(), bound.bindings.end(),
                                    [](const Binding& b) { return b.field == WheelField::Radius; });
    if (!radius || !(p.lower < p.upper)) continue;
    p.lower = p.upper = p.nominal;
    for (RobotParameter& own : dataset.robot.parameters)
      if (own.name == p.name) own = p;
    dataset.notes.push_back(fmt::format(
        "reference: a gyro's headings, which tell ratios of lengths only: {} is held at its nominal "
        "{:.6g} m, all other lengths are by it; x, y of the reference are the wheels' with nominal "
        "values along the gyro's headings",
        p.name, p.nominal));
    return;
  }
}

void draw_path(const Matrix& motions, Reference& reference) {
  Matrix by_gyro = motions, poses(3, motions.cols() + 1);
  for (Index k = 0; k < motions.cols(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    by_gyro(2, k) = reference.theta[i + 1] - reference.theta[i];
  }
  robots::integrate(robots::IntegrationRule::Arc, by_gyro, {0, 0, reference.theta.front()}, poses);
  for (Index k = 0; k < poses.cols(); ++k) {
    reference.x[static_cast<std::size_t>(k)] = poses(0, k);
    reference.y[static_cast<std::size_t>(k)] = poses(1, k);
  }
}

}  // namespace

void complete_heading_reference(Dataset& dataset) {
  if (dataset.reference != ReferenceKind::Headings) return;
  const robots::WheeledRobot robot(dataset.robot.table);
  const WheeledForm form(robot, dataset.recordings, {});
  for (std::size_t i = 0; i < dataset.recordings.size(); ++i) {
    Reference& reference = dataset.recordings[i].reference;
    Matrix motions(3, form.signals(i).cols());
    robot.twists(form.signals(i), robot.nominal(), motions);
    if (!reference.sample.empty()) {  // from one of its stamps to the next
      Matrix sums = Matrix::Zero(3, static_cast<Index>(reference.sample.size()) - 1);
      for (std::size_t e = 1; e < reference.sample.size(); ++e)
        sums.col(static_cast<Index>(e) - 1) =
            motions
                .middleCols(static_cast<Index>(reference.sample[e - 1]),
                            static_cast<Index>(reference.sample[e] - reference.sample[e - 1]))
                .rowwise()
                .sum();
      motions = std::move(sums);
    }
    draw_path(motions, reference);
  }
  hold_a_radius(dataset);
}

}  // namespace odobench
