// Layouts of the standard messages that carry motion, for recordings that have no definitions inside (rosbag2
// before ROS 2 Iron). Facts of common_interfaces, geometry2 and rcl_interfaces; a layout is a list of fields.
#include <array>
#include <utility>

#include "datasets/logs/ros/messages/message_definition.hpp"

namespace odobench {
namespace {

constexpr std::array kStandardMessages{
    std::pair{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id"},
    std::pair{"std_msgs/Bool", "bool data"},
    std::pair{"std_msgs/Int16", "int16 data"},
    std::pair{"std_msgs/Int32", "int32 data"},
    std::pair{"std_msgs/Int64", "int64 data"},
    std::pair{"std_msgs/UInt16", "uint16 data"},
    std::pair{"std_msgs/UInt32", "uint32 data"},
    std::pair{"std_msgs/UInt64", "uint64 data"},
    std::pair{"std_msgs/Float32", "float32 data"},
    std::pair{"std_msgs/Float64", "float64 data"},
    std::pair{"std_msgs/String", "string data"},
    std::pair{"std_msgs/MultiArrayDimension", "string label\nuint32 size\nuint32 stride"},
    std::pair{"std_msgs/MultiArrayLayout", "MultiArrayDimension[] dim\nuint32 data_offset"},
    std::pair{"std_msgs/Int16MultiArray", "MultiArrayLayout layout\nint16[] data"},
    std::pair{"std_msgs/Int32MultiArray", "MultiArrayLayout layout\nint32[] data"},
    std::pair{"std_msgs/Int64MultiArray", "MultiArrayLayout layout\nint64[] data"},
    std::pair{"std_msgs/Float32MultiArray", "MultiArrayLayout layout\nfloat32[] data"},
    std::pair{"std_msgs/Float64MultiArray", "MultiArrayLayout layout\nfloat64[] data"},
    std::pair{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"},
    std::pair{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z"},
    std::pair{"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w"},
    std::pair{"geometry_msgs/Pose", "Point position\nQuaternion orientation"},
    std::pair{"geometry_msgs/Pose2D", "float64 x\nfloat64 y\nfloat64 theta"},
    std::pair{"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation"},
    std::pair{"geometry_msgs/Twist", "Vector3 linear\nVector3 angular"},
    std::pair{"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance"},
    std::pair{"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance"},
    std::pair{"geometry_msgs/PoseStamped", "std_msgs/Header header\nPose pose"},
    std::pair{"geometry_msgs/PointStamped", "std_msgs/Header header\nPoint point"},
    std::pair{"geometry_msgs/TwistStamped", "std_msgs/Header header\nTwist twist"},
    std::pair{"geometry_msgs/Vector3Stamped", "std_msgs/Header header\nVector3 vector"},
    std::pair{"geometry_msgs/PoseWithCovarianceStamped", "std_msgs/Header header\nPoseWithCovariance pose"},
    std::pair{"geometry_msgs/TwistWithCovarianceStamped",
              "std_msgs/Header header\nTwistWithCovariance twist"},
    std::pair{"geometry_msgs/TransformStamped",
              "std_msgs/Header header\nstring child_frame_id\nTransform transform"},
    std::pair{"nav_msgs/Odometry",
              "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
              "geometry_msgs/TwistWithCovariance twist"},
    std::pair{
        "sensor_msgs/JointState",
        "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort"},
    std::pair{"sensor_msgs/Imu",
              "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
              "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
              "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
              "float64[9] linear_acceleration_covariance"},
    std::pair{"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms"}};

}  // namespace

std::string_view standard_message(std::string_view type) {
  for (const auto& [name, text] : kStandardMessages)
    if (type == name) return text;
  return {};
}

}  // namespace odobench
