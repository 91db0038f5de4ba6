// The linear model of a run's residuals around a point, and its damped steps inside the box: what
// Levenberg-Marquardt works with.
#pragma once

#include "solvers/run.hpp"

namespace odobench {

// What a step is measured with, D in lambda |D d|^2.
enum class StepScale {
  LargestColumn,  // D_i the largest |J_i| met so far (More 1978)
  Box             // D_i the same for all: unit coordinates, whose unit is half the box
};

// Everything is in units of |r| at the point, so that no factor on the cost changes a bit or leaves the range
// of doubles.
class LocalModel {
 public:
  // `problem` decides the form: its own normal equations, or a QR factor of the Jacobian.
  LocalModel(const Problem& problem, StepScale scale);

  // Derivatives at u, one evaluation of the run. False, and the model stays as it was, where they are not
  // finite or the run has been stopped.
  bool evaluate(Run& run, const Vector& u);
  double cost() const { return cost_; }
  // max over free i of |J'r|_i / (|J_i| |r|), see solvers/certificate/optimality.hpp.
  double projected_cosine(const Vector& u) const;
  // argmin |r + J d|^2 + lambda |D d|^2 in lower <= d <= upper.
  Vector step(double lambda, const Vector& lower, const Vector& upper) const;
  // What the undamped model gains by d, as a part of the cost.
  double decrease(const Vector& d) const;
  // The part of the cost that rounding explains at u.
  double rounding_part(const Run& run, const Vector& u) const;

 private:
  bool evaluate_normal_equations(Run& run, const Vector& u);
  bool evaluate_residuals(Run& run, const Vector& u);
  void remember(const Vector& squares, double cost);

  bool factored_;
  StepScale scale_;
  double cost_ = 0;
  Vector gradient_;   // J'r / r'r
  Vector length_;     // |J_i| / |r|
  Matrix curvature_;  // J'J / r'r where normal equations are used
  Matrix factor_;     // R / |r|, J = Q R, else
  Vector rotated_;    // Q'r / |r|
  Vector damping_;    // D^2 / r'r
};

}  // namespace odobench
