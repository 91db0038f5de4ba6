// The rows of one wheel at one sample, and their derivatives by the wheel's fields
// (datasets/robots/wheel.hpp has the equations).
//
// A row is a (vx, vy, omega)' = b. With a = e + tan(roller) n the drive row is (a_x, a_y, p x a), its right
// side radius w - (tan(roller) trail - offset) phi'; the side row is (n_x, n_y, p x n), its right side -trail
// phi'. phi' is the rate of the steering, which moves the contact; 0 where it is neglected. By phi: e' = n,
// n' = -e, p' = trail n - offset e.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "datasets/robots/wheel.hpp"

namespace odobench::robots {

// A wheel's fields for one parameter vector.
struct WheelNumbers {
  double x, y;
  double mount, heading;  // heading: mount, and zero where steered
  double cosine, sine;    // of it
  double radius, tangent, offset, trail, gain;
  bool steered;
};

// What a wheel's sensors say at one sample: drive speed, steering, and its rate.
struct WheelReading {
  double drive = 0, steering = 0, rate = 0;
};

struct Contact {
  double ex, ey;  // n = (-ey, ex)
  double px, py;
  double ax, ay;
  Eigen::Vector3d drive_row() const { return {ax, ay, px * ay - py * ax}; }
  Eigen::Vector3d side_row() const { return {-ey, ex, px * ex + py * ey}; }
};

inline Contact contact(const WheelNumbers& w, double steering) {
  Contact c;
  if (w.steered) {
    const double phi = w.heading + w.gain * steering;
    c.ex = std::cos(phi);
    c.ey = std::sin(phi);
  } else {
    c.ex = w.cosine;
    c.ey = w.sine;
  }
  c.px = w.x + w.trail * c.ex - w.offset * c.ey;
  c.py = w.y + w.trail * c.ey + w.offset * c.ex;
  c.ax = c.ex - w.tangent * c.ey;
  c.ay = c.ey + w.tangent * c.ex;
  return c;
}

inline double drive_right_side(const WheelNumbers& w, const WheelReading& r) {
  return w.radius * r.drive - (w.tangent * w.trail - w.offset) * w.gain * r.rate;
}
inline double side_right_side(const WheelNumbers& w, const WheelReading& r) {
  return -w.trail * w.gain * r.rate;
}

struct RowDerivatives {
  Eigen::Vector3d drive = Eigen::Vector3d::Zero(), side = Eigen::Vector3d::Zero();
  double drive_right = 0, side_right = 0;
};

RowDerivatives row_derivatives(const WheelNumbers& w, const Contact& c, const WheelReading& r,
                               WheelField field);

// Solves N x = b for a symmetric positive definite 3 x 3 matrix N of which the lower triangle counts.
class Cholesky3 {
 public:
  explicit Cholesky3(const Eigen::Matrix3d& n) {
    d0_ = n(0, 0);
    l10_ = n(1, 0) / d0_;
    l20_ = n(2, 0) / d0_;
    d1_ = n(1, 1) - l10_ * n(1, 0);
    const double m21 = n(2, 1) - l10_ * n(2, 0);
    l21_ = m21 / d1_;
    d2_ = n(2, 2) - l20_ * n(2, 0) - l21_ * m21;
  }
  // Not positive, or not a number: no such matrix.
  bool positive() const { return d0_ > 0 && d1_ > 0 && d2_ > 0; }
  double determinant() const { return d0_ * d1_ * d2_; }
  Eigen::Vector3d solve(const Eigen::Vector3d& b) const {
    const double y1 = b[1] - l10_ * b[0], y2 = b[2] - l20_ * b[0] - l21_ * y1;
    const double x2 = y2 / d2_, x1 = y1 / d1_ - l21_ * x2;
    return {b[0] / d0_ - l10_ * x1 - l20_ * x2, x1, x2};
  }

 private:
  double d0_, d1_, d2_, l10_, l20_, l21_;
};

}  // namespace odobench::robots
