// The Hamiltonian of a window with the five continuous unknowns eliminated, as three independent concave
// quadratics:
//     H(t) = H0 + sum_B ( g_B' t_B - t_B' Q_B t_B ),   B = x (N-2), y (N-2), r (N-1),
// an exact identity. Q depends on the constants alone, the data enter H0 and g. The sums over the four wheels
// are three orthogonal modes X(n), Y(n), R(n), so sx, sy and r do not meet in any term.
#pragma once

#include <span>
#include <vector>

#include "problems/block_quadratic.hpp"
#include "problems/entropy/entropy_model.hpp"

namespace odobench {

// What a sample contributes to every window it is in.
struct SampleModes {
  double x = 0, y = 0;      // X, Y: sums of the wheels' displacements in the filter frame [m]
  double cax = 0, cay = 0;  // mean acceleration of this sample and the one before it [m/s^2]
  double rho = 0;           // weighted mean of encoder and gyro rotation as wheel displacement [m]
  double rest = 0;          // what no choice of the unknowns can explain, a part of -H0
};

// The optimum without increments, where every window starts.
struct WindowZero {
  double h0 = 0;
  EntropyState state;
};

class ProfileForm {
 public:
  // Throws std::invalid_argument when the constants are not valid.
  explicit ProfileForm(const EntropyConstants& constants);

  const EntropyConstants& constants() const { return constants_; }
  // Q_x, Q_y (equal), Q_r with the places of their entries in the thesis' order of t; g is zero.
  const std::vector<QuadraticBlock>& blocks() const { return blocks_; }

  // `window`: the modes of N samples in order; g (3N-5): blocks x, y, r one after the other.
  WindowZero linear_term(const SampleModes* window, std::span<double> g) const;

  // The closed form of the continuous unknowns at t (3N-5, blocks one after the other).
  EntropyState closed_form(const WindowZero& zero, std::span<const double> t) const;

  // -H(t) of a window as a cost to be minimised. Throws std::invalid_argument when the window is not valid or
  // its constants are not these.
  BlockQuadratic cost(const EntropyWindow& window) const;

 private:
  friend class ModeReader;
  EntropyConstants constants_;
  std::vector<QuadraticBlock> blocks_;
  double inverse_k_[3];                             // K^-1: entries 11, 12, 22
  std::vector<double> shift_of_s1_, shift_of_a12_;  // K^-1 b_j times the step, j = 1..N-2
  std::vector<double> shift_of_r1_;                 // (T / (k N)) (N - m) times the step, m = 1..N-1
  double time_squared_, encoder_weight_, acceleration_weight_, rotation_weight_;  // dt^2, 1/sigma^2
  double k_, r_weight_;                                                           // degrees per metre; W
  double scale_xy_, scale_r_;                                                     // of g
};

// Samples -> modes; keeps what one sample needs of the one before it.
class ModeReader {
 public:
  explicit ModeReader(const ProfileForm& profile);
  SampleModes read(const EntropySample& sample);

 private:
  const ProfileForm& profile_;
  double alpha_;
  std::array<double, 4> steering_{}, cos_{}, sin_{}, turn_{};  // of the steering angles last seen
  double ax_ = 0, ay_ = 0;
};

// The modes of the last N samples in order, contiguous in memory.
class SampleHistory {
 public:
  explicit SampleHistory(const ProfileForm& profile);
  void push(const EntropySample& sample);
  bool full() const { return end_ - begin_ == samples_; }
  const SampleModes* window() const { return &modes_[begin_]; }

 private:
  ModeReader reader_;
  std::size_t samples_, begin_ = 0, end_ = 0;
  std::vector<SampleModes> modes_;
};

}  // namespace odobench
