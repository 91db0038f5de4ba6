// Four-wheel robot with per-wheel motors, T. Stirblys, master's thesis, Kaunas University of Technology,
// 2015, (2.5)-(2.19). World frame: x, y, heading theta counter-clockwise; body frame: x forward, y left. The
// signs of (2.19) put the wheels at 1 (-a, +b), 2 (+a, +b), 3 (+a, -b), 4 (-a, -b): rear-left, front-left,
// front-right, rear-right.
//
// With steering angles xi_i, wheel directions e_i = (cos xi_i, sin xi_i), positions p_i, R = R(theta):
//   as published   F_i = k r w_i e_i,   m v' = R sum F_i - ktr v,   Izz theta'' = T - krot theta'
//   (2.17)-(2.19)
//                  T = sum x_i F_iy - y_i F_ix, in the thesis with k w_i for F_i: without r
//   wheel contact  F_i = k (r w_i - v_i.e_i) e_i - klat (v_i.n_i) n_i with the velocity v_i of the wheel's
//   centre and
//                  n_i = (-sin xi_i, cos xi_i); no ktr, krot. For klat = k it is the published form with ktr
//                  = 4 k, krot = 4 k (a^2 + b^2): the friction of the thesis is that of a wheel that slips as
//                  easily sideways.
// The load torque of a wheel is r times the force along its direction.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "problems/simulation/motors/motor.hpp"

namespace odobench::dynamics {

inline constexpr std::size_t kWheels = 4;
using PerWheel = std::array<double, kWheels>;

// SI units.
struct RobotParameters {
  MotorParameters motor;
  double mass = 5;              // m, kg
  double yaw_inertia = 0;       // Izz, kg m2
  double half_length = 0.3875;  // a, m
  double half_width = 0.275;    // b, m
  double wheel_radius = 0.08;   // r, m
  double drive_gain = 25;       // k, N s/m
  double lateral_gain = 250;    // klat, N s/m, of the wheel contact
  double linear_friction = 0;   // ktr, N s/m, as published
  double rotary_friction = 0;   // krot, N m s/rad, as published
};

// What of the published model is corrected. The default corrects all.
struct ModelOptions {
  bool torque_with_radius = true;  // the forces of the torque have the factor r, as those of the motion have
  bool wheel_contact = true;       // forces depend on the wheel's slip, sideways other than ahead
  bool load_torque = true;         // what drives the body brakes the wheel

  static ModelOptions as_published() { return {false, false, false}; }
  // Throws std::invalid_argument: a contact whose torque lacks r would be no contact.
  void validate() const;
};

// "hint": k and the voltage step of the filter run are such that its largest changes of acceleration,
// 0.087323643 m/s2 and 0.021388556 rad/s2 per 0.1 s, are the constants that the thesis prints. "grip": wheels
// that hardly slip. Throws std::invalid_argument on another name.
RobotParameters robot_set(const std::string& name);
std::vector<std::string> robot_set_names();
inline constexpr double kHintVoltageStep = 0.799118732834;  // V, on wheels 3 and 4

// Every parameter with what it is and where its value comes from.
struct ParameterDescription {
  const char* name;    // "mass"
  const char* symbol;  // as in the thesis
  const char* unit;
  bool given;  // by the thesis (table 2.1, figure 2.8); else chosen
  bool may_be_zero;
  double most;  // more is a typing error
  const char* text;
  double& (*value)(RobotParameters&);
};
const std::vector<ParameterDescription>& parameter_descriptions();

// Throws std::invalid_argument "mass is -5 kg, expected a positive number" or "..., expected at most 1e+06
// kg".
void validate(const RobotParameters& parameters);

// Of the robot, with the integrals that its power balances need [J] and the wheels' turns.
enum StateIndex : std::size_t {
  kCurrent = 0,  // 4, A
  kSpeed = 4,    // 4, rad/s
  kVx = 8,       // m/s, world
  kVy,
  kX,  // m, world
  kY,
  kTheta,            // rad
  kOmega,            // rad/s
  kAngle,            // 4, angle turned by each wheel, rad
  kElectrical = 18,  // work of the batteries: integral of sum u i
  kOhmic,            // heat of the windings: sum R i^2
  kBearing,          // heat of the bearings: sum kdc w^2
  kLoad,             // taken from the wheels by the load torque
  kDrive,            // given to the body by the drive forces
  kFriction,         // taken from the body by friction (published), or heat of the contacts (wheel contact)
  kStateSize
};
using State = std::array<double, kStateSize>;

struct Inputs {
  PerWheel voltage{};   // V
  PerWheel steering{};  // xi, rad
};

// d/dt of the state, the right side of the model.
State rates(const RobotParameters& parameters, const ModelOptions& options, const Inputs& inputs,
            const State& state);

// What is left of the two balances, J; zero but for the integration error.
//   body:  drive - friction - (m |v|^2 + Izz omega^2) / 2        motor: electrical - ohmic - bearing - load -
//          stored
struct Balance {
  double body = 0, motor = 0;
};
Balance balance(const RobotParameters& parameters, const State& state);

// Where the published model (with or without r in the torque) settles under constant speeds and steering:
// rotation T / krot, speed |f| / sqrt(ktr^2 + m^2 omega^2), sideslip -atan(m omega / ktr) against the force
// f.
struct CircularMotion {
  double omega = 0, speed = 0, sideslip = 0;
};
CircularMotion published_steady_state(const RobotParameters& parameters, bool torque_with_radius,
                                      const PerWheel& speed, const PerWheel& steering);

}  // namespace odobench::dynamics
