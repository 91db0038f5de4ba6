// Direct-current motor of one wheel, T. Stirblys, master's thesis, Kaunas University of Technology, 2015,
// (2.3)-(2.4):
//     di/dt = (u - R i - cphi w) / La                                                       (2.3)
//     dw/dt = (cphi i - kdc w - load) / Iw                                                  (2.4), there
//     without load
// with the voltage u [V], current i [A], wheel speed w [rad/s] and load torque [N m]: what the ground takes
// from the wheel. The thesis has none, so that its ground forces are free energy.
#pragma once

namespace odobench::dynamics {

struct Vec2 {
  double x = 0, y = 0;
};

// SI units. None of these values is in the thesis; the defaults are chosen for a wheel of this size.
struct MotorParameters {
  double resistance = 2.0;     // R, ohm
  double inductance = 0.005;   // La, H
  double flux_constant = 0.8;  // cphi, V s/rad and N m/A
  double inertia = 0.02;       // Iw, kg m2
  double bearing_loss = 0.05;  // kdc, N m s/rad
};

struct MotorRates {
  double current = 0;  // di/dt, A/s
  double speed = 0;    // dw/dt, rad/s2
};

constexpr MotorRates motor_rates(const MotorParameters& p, double voltage, double current, double speed,
                                 double load) {
  return {(voltage - p.resistance * current - p.flux_constant * speed) / p.inductance,
          (p.flux_constant * current - p.bearing_loss * speed - load) / p.inertia};
}

// Where current [A] and speed [rad/s] settle under a constant voltage without load.
struct MotorState {
  double current = 0, speed = 0;
};
constexpr MotorState motor_steady_state(const MotorParameters& p, double voltage) {
  const double speed =
      voltage * p.flux_constant / (p.resistance * p.bearing_loss + p.flux_constant * p.flux_constant);
  return {p.bearing_loss * speed / p.flux_constant, speed};
}

}  // namespace odobench::dynamics
