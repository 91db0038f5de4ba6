// The forward kinematics of any wheeled robot that is a table of wheels (datasets/robots/wheel.hpp): twists
// (vx, vy, omega) of the body from its wheels' signals, with derivatives by the parameters z.
//
// Least squares: all rows together are A t = b; t = (A'A)^-1 A'b, and with the slip q = b - A t
//     dt = (A'A)^-1 (dA'q + A'(db - dA t)).
// Published mean (J. Vitko's thesis, 2.16-2.17): t = 1/N sum (v e, v (p x e) / |p|^2), v = radius w.
//
// Signals are a K x N matrix, one column per sample, rows as signals() names them: first what drives the
// wheels, then steering angles in rad. The twist is linear in the drive signals: with speeds (rad/s) it is a
// velocity, with increments (rad per interval) the motion of the interval. A steered wheel whose contact lies
// beside its pivot rolls when it is steered; that is neglected unless the rates of the steering signals are
// given (one row per steering signal, in their order; rad/s, or rad per interval where the drives are
// increments).
//
// Bad shapes, values that are not finite: std::invalid_argument. Wheels that do not tell the twist at a
// sample (least singular value of A, third column over the largest |p|, below 1e-6 of the largest): DataError
// with sample and rows. Immutable; every member may be called from several threads.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/robots/wheel.hpp"
#include "problems/matrices.hpp"

namespace odobench::robots {

struct WheelNumbers;  // problems/robots/wheel_rows.hpp

// All rows at one sample: A (m x 3), b (m), and what each row is: "wheel 2 drive".
struct WheelRows {
  Matrix a;
  Vector b;
  std::vector<std::string> names;
};

// Throws std::invalid_argument in one line, naming the wheel or parameter: no wheels; a value that is not
// finite; lower <= nominal <= upper violated; unknown units; a name twice; a binding that changes nothing
// (radius of a wheel without drive, zero of one that is not steered); a driven wheel without radius; a signal
// that drives and steers; fewer than three rows; the mean of wheels that are not all steered, driven and
// plain.
void check(const WheelTable& table);

class WheeledRobot {
 public:
  // check(table), and that the wheels tell the twist at the nominal values where no steering changes the
  // rows.
  explicit WheeledRobot(WheelTable table);

  const WheelTable& table() const { return table_; }
  const std::vector<RobotParameter>& parameters() const { return parameters_; }
  Vector nominal() const;
  // Drive signals in order of first use, then steering signals.
  const std::vector<std::string>& signals() const { return signals_; }
  Eigen::Index drive_count() const { return drive_count_; }

  // twists: 3 x N.
  void twists(const ConstMatrixRef& signals, const ConstVectorRef& z, MatrixRef twists,
              const Matrix* rates = nullptr) const;
  // jacobian: 3N x n, rows vx, vy, omega of sample 0, of sample 1, ...
  void twists_and_jacobian(const ConstMatrixRef& signals, const ConstVectorRef& z, MatrixRef twists,
                           MatrixRef jacobian, const Matrix* rates = nullptr) const;
  // |b - A t| per sample: how much the wheels contradict each other, m/s or m. Of the twist by the table's
  // rule.
  Vector residual_norms(const ConstMatrixRef& signals, const ConstVectorRef& z,
                        const Matrix* rates = nullptr) const;
  // The equations of one sample (signals: K x 1).
  WheelRows rows(const ConstMatrixRef& signals, const ConstVectorRef& z, const Matrix* rates = nullptr) const;

  // The signals (K) with which the robot moves with this twist; steering in [-pi/2, pi/2] about the mount,
  // wheels running backwards where needed. A steered wheel whose pivot is slower than 1e-9 m/s keeps its
  // steering in `held` (K; 0 when empty). Throws std::invalid_argument for a twist that the robot cannot do,
  // naming the wheel.
  Vector inverse(const Eigen::Vector3d& twist, const ConstVectorRef& z, const Vector& held = {}) const;

  // The published mean is the least-squares twist for every signal: contacts at their pivots, centred on the
  // origin and equally far from it (to 1e-12).
  bool mean_equals_least_squares(const ConstVectorRef& z) const;

  // twists = matrix(z) streams(signals), with streams (S x N) that do not depend on z: for fixed wheels, for
  // steered ones with their contact at the pivot their drive times cos and sin of the steering (A'A does not
  // depend on it, since both rows of such a wheel are a rotation of u = radius w e), for a bicycle without
  // steering zero w and w tan(steering). Fields held fixed at 0 (lower == upper) count as 0; the members
  // below refuse a z that has another value there.
  bool is_linear() const { return form_ != LinearForm::None; }
  // Throw std::logic_error unless is_linear().
  Eigen::Index stream_count() const { return static_cast<Eigen::Index>(streams_.size()); }
  Matrix streams(const ConstMatrixRef& signals) const;
  Matrix matrix(const ConstVectorRef& z) const;  // 3 x S
  // derivatives: n matrices 3 x S; 0 by parameters that are held fixed.
  void matrix_and_derivatives(const ConstVectorRef& z, Matrix& matrix,
                              std::vector<Matrix>& derivatives) const;

 private:
  // What of a wheel does not depend on z.
  struct Plan {
    std::vector<std::pair<Eigen::Index, double>> drives;  // row of the signals, weight
    Eigen::Index steering = -1;                           // row of the signals, -1: not steered
    bool driven = false, slides = false;
  };
  struct Term {
    Eigen::Index parameter;
    double factor;
  };
  struct BoundField {
    std::size_t wheel;
    WheelField field;
    std::vector<Term> terms;
  };
  enum class LinearForm { None, Wheels, Bicycle };
  enum class StreamKind { Drive, Cosine, Sine, Tangent };
  struct Stream {
    std::size_t wheel;
    StreamKind kind;
    std::size_t steered_by;  // the wheel whose steering it takes
  };
  struct Workspace;

  void plan_signals();
  void plan_fields();
  void plan_streams();
  bool is_zero(std::size_t wheel, WheelField field) const;
  bool is_constant(std::size_t wheel, WheelField field) const;
  std::vector<WheelNumbers> numbers(const ConstVectorRef& z) const;
  void check_signals(const ConstMatrixRef& signals, const Matrix* rates) const;
  Workspace start(const ConstMatrixRef& signals, const ConstVectorRef& z, const Matrix* rates) const;
  void read(Workspace& w, const ConstMatrixRef& signals, const Matrix* rates, Eigen::Index k) const;
  Eigen::Vector3d solve(Workspace& w, Eigen::Index k) const;
  Eigen::Vector3d mean(const Workspace& w) const;
  void refuse_rank(const Workspace& w, Eigen::Index k) const;
  WheelRows rows_of(const Workspace& w) const;
  Eigen::Vector3d derivative(const Workspace& w, const Eigen::Vector3d& twist, const BoundField& field) const;
  Eigen::Vector3d mean_derivative(const Workspace& w, const BoundField& field) const;
  void check_linear(const ConstVectorRef& z) const;
  void linear_form(const ConstVectorRef& z, Matrix& matrix, std::vector<Matrix>* derivatives) const;
  void bicycle_matrix(const std::vector<WheelNumbers>& wheels, Matrix& matrix,
                      std::vector<Matrix>* derivatives) const;
  void wheels_matrix(const std::vector<WheelNumbers>& wheels, Matrix& matrix,
                     std::vector<Matrix>* derivatives) const;
  void mean_matrix(const std::vector<WheelNumbers>& wheels, Matrix& matrix,
                   std::vector<Matrix>* derivatives) const;

  WheelTable table_;
  std::vector<RobotParameter> parameters_;
  std::vector<std::string> signals_;
  Eigen::Index drive_count_ = 0;
  std::vector<Plan> plans_;
  std::vector<BoundField> fields_;  // wheel by wheel
  std::vector<Stream> streams_;
  LinearForm form_ = LinearForm::None;
};

}  // namespace odobench::robots
