#include "tests/support/faulty_sets.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "problems/inspection/set_checks.hpp"
#include "problems/simulation/robot_demo.hpp"

namespace odobench::testing {
namespace {

using Values = std::vector<double>;

Signal& signal(Recording& r, const std::string& name) {
  return *std::find_if(r.signals.begin(), r.signals.end(), [&](const Signal& s) { return s.name == name; });
}
Values& wheel(Recording& r, int i) {
  return signal(r, "wheel." + std::to_string(i)).values;
}
Values& steering(Recording& r, int i) {
  return signal(r, "steering." + std::to_string(i)).values;
}
void scale(Values& v, double factor) {
  for (double& one : v) one *= factor;
}
void for_wheels(Dataset& d, double factor) {
  for (Recording& r : d.recordings)
    for (int i = 1; i <= 4; ++i) scale(wheel(r, i), factor);
}
void for_poses(Dataset& d, const std::function<void(double&, double&, double&)>& change) {
  for (Recording& r : d.recordings)
    for (std::size_t k = 0; k < r.size(); ++k)
      change(r.reference.x[k], r.reference.y[k], r.reference.theta[k]);
}
std::size_t middle(const Recording& r) {
  return r.size() / 2;
}
double usual(const Values& v) {
  Values sizes = v;
  for (double& one : sizes) one = std::abs(one);
  std::sort(sizes.begin(), sizes.end());
  return sizes[sizes.size() * 95 / 100];
}

void shift_reference(Dataset& d, double seconds) {
  for (Recording& r : d.recordings) {
    Eigen::VectorXd t(static_cast<Eigen::Index>(r.size()));
    for (std::size_t k = 0; k < r.size(); ++k)
      t[static_cast<Eigen::Index>(k)] = 1e-6 * static_cast<double>(r.time_us[k]);
    for (Values* v : {&r.reference.x, &r.reference.y, &r.reference.theta}) {
      const auto moved =
          inspection::shifted(t, Eigen::Map<const Eigen::VectorXd>(v->data(), t.size()), -seconds);
      std::copy(moved.begin(), moved.end(), v->begin());
    }
  }
}

void displace(Dataset& d, double metres) {
  for (Recording& r : d.recordings) {
    const double start = r.reference.theta[0];
    for (std::size_t k = 0; k < r.size(); ++k) {
      r.reference.x[k] += metres * (std::cos(r.reference.theta[k]) - std::cos(start));
      r.reference.y[k] += metres * (std::sin(r.reference.theta[k]) - std::sin(start));
    }
  }
}

void freeze(Dataset& d, double seconds) {
  Recording& r = d.recordings[0];
  const auto count = static_cast<std::size_t>(std::lround(seconds * 20));
  for (std::size_t k = middle(r) + 1; k <= middle(r) + count; ++k)
    for (Values* v : {&r.reference.x, &r.reference.y, &r.reference.theta}) (*v)[k] = (*v)[middle(r)];
}

void slip(Dataset& d, double factor) {
  Recording& r = d.recordings[0];
  for (std::size_t k = middle(r); k < middle(r) + 20; ++k) wheel(r, 1)[k] *= factor;
}

// What the wheel said before its speed changed by more than half.
void repeat_speed(Dataset& d, double seconds) {
  Values& v = wheel(d.recordings[0], 1);
  const auto count = static_cast<std::size_t>(std::lround(seconds * 20));
  std::size_t first = 20;
  while (first + count + 20 < v.size() && std::abs(v[first + 5] - v[first]) < 0.5 * usual(v)) ++first;
  for (std::size_t k = first; k < first + count; ++k) v[k] = v[first];
}

void exchange(Recording& r, int i, int j) {
  std::swap(wheel(r, i), wheel(r, j));
  std::swap(steering(r, i), steering(r, j));
}

void cut_out(Dataset& d, double seconds) {
  Recording& r = d.recordings[0];
  const auto first = static_cast<std::ptrdiff_t>(middle(r)),
             last = first + static_cast<std::ptrdiff_t>(std::lround(seconds * 20));
  const auto erase = [&](auto& v) { v.erase(v.begin() + first, v.begin() + last); };
  erase(r.time_us);
  for (Signal& s : r.signals) erase(s.values);
  for (Values* v : {&r.reference.x, &r.reference.y, &r.reference.theta}) erase(*v);
}

// Every drive gets the reference of another trajectory, stretched to its length.
void exchange_references(Dataset& d) {
  std::vector<Reference> all;
  for (const Recording& r : d.recordings) all.push_back(r.reference);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Recording& r = d.recordings[i];
    std::size_t other = (i + 1) % all.size();
    while (d.recordings[other].trajectory == r.trajectory) other = (other + 1) % all.size();
    const std::size_t n = all[other].x.size();
    for (std::size_t k = 0; k < r.size(); ++k) {
      const std::size_t at = k * (n - 1) / (r.size() - 1);
      r.reference.x[k] = all[other].x[at];
      r.reference.y[k] = all[other].y[at];
      r.reference.theta[k] = all[other].theta[at];
    }
  }
}

// Nominal values of the parameters whose name begins with the letter, and their boxes.
void scale_nominal(Dataset& d, char letter, double factor) {
  std::vector<RobotParameter> parameters = d.robot.parameters;
  for (RobotParameter& p : parameters)
    if (p.name[0] == letter) {
      p.nominal *= factor;
      p.lower *= factor;
      p.upper *= factor;
    }
  d.robot = robot_of_class("4wis4wid", parameters);
}

void move_axle(Dataset& d, double share) {
  std::vector<RobotParameter> parameters = d.robot.parameters;
  for (RobotParameter& p : parameters)
    if (p.name == "a2" || p.name == "a3") {
      p.nominal *= 1 - share;
      p.lower = -0.2;
      p.upper = 0.1;
    }
  d.robot = robot_of_class("4wis4wid", parameters);
}

std::vector<Fault> unit_faults() {
  return {
      {"heading_degrees",
       "heading_degrees",
       {1},
       "",
       [](Dataset& d, double) { for_poses(d, [](double&, double&, double& theta) { theta /= kDegree; }); },
       true},
      {"heading_sign",
       "heading_sign",
       {1},
       "",
       [](Dataset& d, double) { for_poses(d, [](double&, double&, double& theta) { theta = -theta; }); },
       true},
      {"millimetres",
       "position_unit",
       {1000},
       "",
       [](Dataset& d, double size) {
         for_poses(d, [size](double& x, double& y, double&) { x *= size, y *= size; });
       },
       true},
      {"inches",
       "position_unit",
       {1 / 0.0254},
       "",
       [](Dataset& d, double size) {
         for_poses(d, [size](double& x, double& y, double&) { x *= size, y *= size; });
       },
       true},
      {"y_to_the_right",
       "frame_mirrored",
       {1},
       "",
       [](Dataset& d, double) { for_poses(d, [](double&, double& y, double&) { y = -y; }); },
       true},
      {"x_and_y_exchanged",
       "frame_mirrored",
       {2},
       "",
       [](Dataset& d, double) { for_poses(d, [](double& x, double& y, double&) { std::swap(x, y); }); },
       true},
      {"z_down",
       "frame_mirrored",
       {3},
       "",
       [](Dataset& d, double) {
         for_poses(d, [](double&, double& y, double& theta) { y = -y, theta = -theta; });
       },
       true},
      {"centimetres",
       "position_unit",
       {100},
       "",
       [](Dataset& d, double size) {
         for_poses(d, [size](double& x, double& y, double&) { x *= size, y *= size; });
       },
       true},
      {"steering_degrees",
       "steering_degrees",
       {1},
       "",
       [](Dataset& d, double) {
         for (Recording& r : d.recordings)
           for (int i = 1; i <= 4; ++i) scale(steering(r, i), 1 / kDegree);
       },
       true},
      {"rpm", "common_factor", {60 / (2 * kPi)}, "", for_wheels, true},
      {"turns_per_second", "common_factor", {1 / (2 * kPi)}, "", for_wheels, true},
      {"degrees_per_second", "common_factor", {180 / kPi}, "", for_wheels, true},
      {"diameter",
       "common_factor",
       {2},
       "",
       [](Dataset& d, double size) { scale_nominal(d, 'r', size); },
       true},
      {"milliseconds",
       "time_unit",
       {1},
       "",
       [](Dataset& d, double) {
         for (Recording& r : d.recordings)
           for (std::int64_t& t : r.time_us) t /= 1000;
       },
       true},
      {"speed_factor", "common_factor", {1.05, 1.10, 1.15, 1.20}, "times", for_wheels},
  };
}

std::vector<Fault> column_faults() {
  return {
      {"wheel_order",
       "wheel_order",
       {1},
       "",
       [](Dataset& d, double) {
         for (Recording& r : d.recordings) {
           exchange(r, 2, 4);
           exchange(r, 3, 4);
         }
       },
       true},
      {"steering_sign",
       "steering_sign",
       {1},
       "",
       [](Dataset& d, double) {
         for (Recording& r : d.recordings) scale(steering(r, 3), -1);
       },
       true,
       3},
      {"wheel_reversed",
       "wheel_reversed",
       {1},
       "",
       [](Dataset& d, double) {
         for (Recording& r : d.recordings) scale(wheel(r, 2), -1);
       },
       true,
       2},
      {"direction_reversed",
       "direction_reversed",
       {1},
       "",
       [](Dataset& d, double) { for_wheels(d, -1); },
       true},
      {"steering_zero",
       "steering_zero",
       {0.5 * kDegree, kDegree, 1.5 * kDegree, 2 * kDegree, 3 * kDegree},
       "rad",
       [](Dataset& d, double size) {
         for (Recording& r : d.recordings)
           for (double& one : steering(r, 2)) one += size;
       },
       false,
       2},
  };
}

std::vector<Fault> frame_faults() {
  return {
      {"late", "reference_lag", {0.015, 0.020, 0.025, 0.030}, "s", shift_reference, true},
      {"early",
       "reference_lag",
       {0.015, 0.020, 0.025, 0.030},
       "s",
       [](Dataset& d, double size) { shift_reference(d, -size); },
       true},
      {"heading_turned",
       "heading_turned",
       {kDegree, 1.5 * kDegree, 2 * kDegree, 3 * kDegree, 4 * kDegree},
       "rad",
       [](Dataset& d, double size) {
         for_poses(d, [size](double&, double&, double& theta) { theta += size; });
       },
       true},
      {"tracked_point", "tracked_point", {0.010, 0.012, 0.015, 0.020}, "m", displace},
      {"start_offset",
       "start_offset",
       {0.03, 0.06},
       "m",
       [](Dataset& d, double size) { for_poses(d, [size](double& x, double&, double&) { x += size; }); },
       true},
      {"heading_wrapped",
       "heading_wrapped",
       {1},
       "",
       [](Dataset& d, double) {
         for_poses(d, [](double&, double&, double& theta) { theta = wrapped_angle(theta); });
       },
       true},
      {"half_track",
       "rotation_factor",
       {1.1, 1.2, 1.3, 2},
       "times",
       [](Dataset& d, double size) {
         scale_nominal(d, 'a', size);
         scale_nominal(d, 'b', size);
       }},
      {"rear_axle", "layout_asymmetric", {0.05, 0.3, 1}, "of a", move_axle},
  };
}

std::vector<Fault> sample_faults() {
  return {
      {"outlier",
       "pose_outlier",
       {0.02, 0.05, 0.1, 0.2, 1},
       "m",
       [](Dataset& d, double size) { d.recordings[0].reference.y[middle(d.recordings[0])] += size; },
       true},
      {"spike",
       "wheel_spike",
       {8, 10, 12, 20},
       "times",
       [](Dataset& d, double size) {
         Values& v = wheel(d.recordings[0], 1);
         v[middle(d.recordings[0])] = size * usual(v);
       },
       true,
       1},
      {"overflow",
       "encoder_overflow",
       {400},
       "times",
       [](Dataset& d, double size) {
         Values& v = wheel(d.recordings[0], 4);
         v[middle(d.recordings[0])] = size * usual(v);
       },
       true,
       4},
      {"frozen", "capture_frozen", {0.3, 0.4, 0.5, 1}, "s", freeze},
      {"gap", "gap", {0.8, 1.2, 2}, "s", cut_out},
      {"clock_jump",
       "clock_jump",
       {60},
       "s",
       [](Dataset& d, double size) {
         Recording& r = d.recordings[0];
         for (std::size_t k = middle(r); k < r.size(); ++k) r.time_us[k] += std::llround(1e6 * size);
       },
       true},
      {"slip", "wheel_slip", {1.2, 1.3, 1.4, 1.6}, "times", slip, false, 1},
      {"repeats", "speeds_repeat", {0.5, 0.75, 1, 1.5}, "s", repeat_speed, false, 1},
      {"one_wheel_of_one_drive",
       "recording_unlike",
       {1.1, 1.2, 1.3, 1.5},
       "times",
       [](Dataset& d, double size) { scale(wheel(d.recordings[0], 1), size); }},
      {"exchanged_drives", "not_together", {1}, "", [](Dataset& d, double) { exchange_references(d); }},
      {"never_moved",
       "never_moved",
       {1},
       "",
       [](Dataset& d, double) {
         for_poses(d, [](double& x, double& y, double& theta) { x = y = theta = 0; });
       }},
  };
}

}  // namespace

Dataset clean_set(const std::string& kinematics, std::uint64_t seed) {
  Dataset d = make_robot_demo(kinematics, seed);
  for (Recording& r : d.recordings)
    for (Signal& s : r.signals) {
      if (s.kind == SignalKind::Speed) continue;
      // Increments hold from the stamp before, angles beside them too.
      for (std::size_t k = 0; k + 1 < r.size(); ++k)
        s.values[k] =
            s.values[k + 1] /
            (s.kind == SignalKind::Angle ? 1 : 1e-6 * static_cast<double>(r.time_us[k + 1] - r.time_us[k]));
      if (s.kind == SignalKind::Increment) s.kind = SignalKind::Speed;
    }
  return d;
}

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all = [] {
    std::vector<Fault> list = unit_faults();
    for (const auto& more : {column_faults(), frame_faults(), sample_faults()})
      list.insert(list.end(), more.begin(), more.end());
    return list;
  }();
  return all;
}

}  // namespace odobench::testing
