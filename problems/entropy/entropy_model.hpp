// What the relative-entropy filter estimates in one window, and the constants derived from its parameters.
//
// Increments in the order of the thesis' program: delta_ax(2,3), delta_ay(2,3), ..., delta_ax(N-1,N),
// delta_ay(N-1,N), eps(1,2), ..., eps(N-1,N); 3N - 5 of them. A ternary unknown t_i in {-1, 0, 1} stands for
// the increment t_i * step_acceleration (the first 2(N-2)) or t_i * step_rotation (the rest).
#pragma once

#include <Eigen/Core>
#include <array>

#include "datasets/entropy/entropy_window.hpp"

namespace odobench {

// The unknowns that H determines in closed form once the increments are fixed.
struct EntropyState {
  double r1 = 0;              // m, wheel displacement due to rotation in step 1
  double sx1 = 0, sy1 = 0;    // m, displacement in step 1, filter frame
  double ax12 = 0, ay12 = 0;  // m/s^2, acceleration between samples 1 and 2, filter frame
};

// Displacement of every wheel in the filter frame, (2.24)-(2.27), and the rotation in deg, (2.28), of one
// step.
struct EntropyPrediction {
  std::array<double, 4> x{}, y{};
  double rotation = 0;
};

inline int increment_count(int samples) {
  return 3 * samples - 5;
}
double alpha(const EntropyConstants& constants);              // rad, atan(width / length)
double degrees_per_metre(const EntropyConstants& constants);  // k = 180 / (pi L)

// Throws std::invalid_argument naming the constant, its value and what is expected: samples >= 3, everything
// finite, dt, sigmas, sizes and steps > 0.
void validate(const EntropyConstants& constants);
// The same for a window: as many samples as the constants say, all finite.
void validate(const EntropyWindow& window);

// increments (3N-5) in physical units from t (3N-5, not necessarily whole numbers).
Eigen::VectorXd increments(const EntropyConstants& constants, const Eigen::Ref<const Eigen::VectorXd>& t);

// (2.24)-(2.28) with the angles of the constants worked out once.
class Predictor {
 public:
  explicit Predictor(const EntropyConstants& constants);
  EntropyPrediction predict(double sx, double sy, double r) const;

 private:
  double sin_2alpha_, cos_2alpha_, degrees_per_metre_;
};

}  // namespace odobench
