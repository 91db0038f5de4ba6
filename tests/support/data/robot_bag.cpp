#include "tests/support/data/robot_bag.hpp"

#include <cmath>
#include <random>

namespace odobench::testing {
namespace {

constexpr double kStep = 1e-3, kStanding = 3, kPi = 3.14159265358979;
constexpr std::int64_t kBegin = 1'760'000'000'000'000'000, kDelay = 4'000'000;

struct Pose {
  double x = 0, y = 0, yaw = 0;
};

void add_pose(MessageBytes& message, const Pose& at) {
  message.number(at.x).number(at.y).number(0.0);
  message.number(0.0).number(0.0).number(std::sin(at.yaw / 2)).number(std::cos(at.yaw / 2));
}

std::string odometry(RosEncoding encoding, std::int64_t stamp, const char* child, const Pose& at) {
  MessageBytes message(encoding);
  message.header(stamp, "odom").text(child);
  add_pose(message, at);
  for (int i = 0; i < 36 + 6 + 36; ++i) message.number(0.0);
  return message.bytes();
}

WrittenChannel channel(const std::string& topic, const std::string& package, const std::string& type,
                       RosEncoding encoding, std::vector<std::string> parts) {
  parts.insert(parts.begin(), "std_msgs/Header");
  return {topic, package + (encoding == RosEncoding::Ros1 ? "/" : "/msg/") + type,
          full_definition(std::string(standard_message(package + "/" + type)), encoding, parts)};
}

}  // namespace

WrittenLog RobotBag::messages(RosEncoding encoding) const {
  const std::vector<std::string> odometry_parts{"geometry_msgs/PoseWithCovariance",
                                                "geometry_msgs/Pose",
                                                "geometry_msgs/Point",
                                                "geometry_msgs/Quaternion",
                                                "geometry_msgs/Twist",
                                                "geometry_msgs/TwistWithCovariance",
                                                "geometry_msgs/Vector3"};
  WrittenLog log;
  log.encoding = encoding;
  log.channels = {
      channel("/joint_states", "sensor_msgs", "JointState", encoding, {}),
      channel("/imu", "sensor_msgs", "Imu", encoding, {"geometry_msgs/Quaternion", "geometry_msgs/Vector3"}),
      channel("/odom", "nav_msgs", "Odometry", encoding, odometry_parts)};
  if (vision)
    log.channels.push_back(channel("/rtabmap/odom", "nav_msgs", "Odometry", encoding, odometry_parts));
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  double left = 0, right = 0, off = 1.9, theta = 0.6;
  Pose seen{7, -2, 0}, own;
  const auto add = [&](std::size_t to, std::int64_t stamp, std::string data) {
    log.messages.push_back({to, stamp + kDelay, std::move(data)});
  };
  for (int k = 0; k < static_cast<int>(kSeconds / kStep); ++k) {
    const double t = k * kStep, way = (t - kStanding) / (kSeconds - 2 * kStanding);
    const bool drives = way > 0 && way < 1;
    const double bend = drives ? std::pow(std::sin(way * 8 * kPi), 2) : 0;
    const int number = static_cast<int>(way * 8);
    const double v = 0.4 * bend;
    const double w =
        (number % 2 == 0 ? 1 : -1) * (0.4 + 0.1 * ((number / 2 + static_cast<int>(seed)) % 4)) * bend;
    const std::int64_t stamp = kBegin + static_cast<std::int64_t>(k) * 1'000'000;
    if (k % 20 == 0) {
      MessageBytes joints(encoding);
      joints.header(stamp, "").texts({"right_wheel_joint", "left_wheel_joint"}).numbers({right, left});
      joints.numbers({}).numbers({});
      add(0, stamp, joints.bytes());
    }
    if (k % 10 == 5) {
      MessageBytes imu(encoding);
      imu.header(stamp, "imu").number(0.0).number(0.0).number(0.0).number(1.0).number(-1.0);
      for (int i = 1; i < 9; ++i) imu.number(0.0);
      imu.number(0.0).number(0.0).number(gyro_sign * w + gyro_bias + 0.002 * normal(random));
      for (int i = 0; i < 9 + 3 + 9; ++i) imu.number(0.0);
      add(1, stamp, imu.bytes());
    }
    if (k % 100 == 0) add(2, stamp, odometry(encoding, stamp, "base_link", own));
    if (vision && k % 33 == 7) {
      const double yaw = theta + off, c = std::cos(yaw), s = std::sin(yaw);
      Pose at{seen.x + c * mount_x - s * mount_y + pose_noise * normal(random),
              seen.y + s * mount_x + c * mount_y + pose_noise * normal(random),
              yaw + mount_yaw + pose_noise * normal(random)};
      if (z_down) at = {at.x, -at.y, -at.yaw};
      add(3, stamp, odometry(encoding, stamp + std::llround(clock_ahead_s * 1e9), "camera", at));
    }
    left += (v - w * kTrack / 2) / kLeft * kStep;
    right += (v + w * kTrack / 2) / kRight * kStep;
    own.x += v * kStep * std::cos(own.yaw);
    own.y += v * kStep * std::sin(own.yaw);
    own.yaw += w * kStep * 1.03;
    const double root = std::sqrt(v * kStep), middle = theta + off + w * kStep / 2;
    theta += w * kStep;
    seen.x += v * kStep * std::cos(middle) + position_walk * root * normal(random);
    seen.y += v * kStep * std::sin(middle) + position_walk * root * normal(random);
    off += heading_walk * root * normal(random);
  }
  return log;
}

}  // namespace odobench::testing
