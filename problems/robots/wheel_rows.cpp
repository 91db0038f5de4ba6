#include "problems/robots/wheel_rows.hpp"

namespace odobench::robots {
namespace {

// By phi, for a factor `by` = dphi/dfield.
RowDerivatives by_heading(const WheelNumbers& w, const Contact& c, double by) {
  const double nx = -c.ey, ny = c.ex;
  const double ax = nx - w.tangent * c.ex, ay = ny - w.tangent * c.ey;
  const double px = w.trail * nx - w.offset * c.ex, py = w.trail * ny - w.offset * c.ey;
  RowDerivatives d;
  d.drive = {by * ax, by * ay, by * (px * c.ay - py * c.ax + c.px * ay - c.py * ax)};
  d.side = {-by * c.ex, -by * c.ey, by * (px * ny - py * nx - c.px * c.ey + c.py * c.ex)};
  return d;
}

}  // namespace

RowDerivatives row_derivatives(const WheelNumbers& w, const Contact& c, const WheelReading& r,
                               WheelField field) {
  RowDerivatives d;
  const double rate = w.gain * r.rate;
  switch (field) {
    case WheelField::X:
      d.drive[2] = c.ay;
      d.side[2] = c.ex;
      break;
    case WheelField::Y:
      d.drive[2] = -c.ax;
      d.side[2] = c.ey;
      break;
    case WheelField::Mount:
    case WheelField::Zero:
      return by_heading(w, c, 1);
    case WheelField::Gain:
      d = by_heading(w, c, r.steering);
      d.drive_right = -(w.tangent * w.trail - w.offset) * r.rate;
      d.side_right = -w.trail * r.rate;
      break;
    case WheelField::Radius:
      d.drive_right = r.drive;
      break;
    case WheelField::Roller: {  // of tan(roller): 1 + tan^2
      const double slope = 1 + w.tangent * w.tangent;
      d.drive = slope * c.side_row();
      d.drive_right = -slope * w.trail * rate;
      break;
    }
    case WheelField::Offset:  // p' = n
      d.drive[2] = -1;
      d.drive_right = rate;
      break;
    case WheelField::Trail:  // p' = e
      d.drive[2] = w.tangent;
      d.drive_right = -w.tangent * rate;
      d.side[2] = 1;
      d.side_right = -rate;
      break;
  }
  return d;
}

}  // namespace odobench::robots
