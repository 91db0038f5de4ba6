// Robust losses: what a squared error counts for, once it is large.
//
// For the squared error s of a group in units of its scale, and the tuning constant d:
//     squared   rho(s) = s
//     Huber     rho(s) = s for s <= d^2, else 2 d sqrt(s) - d^2
//     Cauchy    rho(s) = d^2 ln(1 + s / d^2)
//     Tukey     rho(s) = d^2 / 3 (1 - max(0, 1 - s / d^2)^3)
// All begin as s does, so that small errors count as in least squares. rho'(s) is the weight of the group
// in iteratively reweighted least squares (P. J. Huber, E. M. Ronchetti, Robust Statistics, 2009).
#pragma once

#include <string>
#include <string_view>

namespace odobench {

enum class LossKind { Squared, Huber, Cauchy, Tukey };
// What is a group: the position error of a row and its heading error, each with a scale of its own, or all
// errors of a recording.
enum class LossScope { Sample, Recording };

// "squared", "huber", "cauchy", "tukey".
std::string_view name_of(LossKind kind);

struct LossValue {
  double rho = 0;
  double weight = 1;  // rho'(s)
  // f = sqrt(rho / s): e f(s) has the square rho. And df/ds.
  double factor = 1, slope = 0;
};

struct Loss {
  LossKind kind = LossKind::Squared;
  LossScope scope = LossScope::Sample;
  double tuning = 0;
  // Per sample: m, rad. Per recording: `position` alone, the scale of sqrt of the mean square of its rows.
  double position_scale = 0, heading_scale = 0;

  bool robust() const { return kind != LossKind::Squared; }
  // s >= 0; not-a-number gives not-a-number.
  LossValue at(double s) const;
  // "squared", "cauchy=2.385", "cauchy=1.5:recording".
  std::string name() const;
  // With the scales: "cauchy=2.385, scale=0.0036:0.0133".
  std::string text() const;
};

// 95 % efficiency for normal errors per sample: 1.345, 2.385, 4.685. Per recording 1.5, 1.5, 4.
double usual_tuning(LossKind kind, LossScope scope);

// "cauchy", "cauchy=2.4", "tukey:recording", "huber=2:sample", "squared"; scales stay 0. Throws
// std::invalid_argument saying what was found and expected.
Loss parse_loss(std::string_view text);

}  // namespace odobench
