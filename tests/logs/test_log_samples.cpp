// One drive in every format of ROS logs: the same counts, stamps and sums.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>

#include "base/json_node.hpp"
#include "datasets/logs/ros/ros_logs.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::data_error;
using testing::refusal_of;
using testing::says;

fs::path samples() {
  return testing::shared_folder() / "datasets" / "logs";
}

#define ODOBENCH_NEEDS_SAMPLES() \
  ODOBENCH_NEEDS_SHARED();       \
  if (!fs::exists(samples() / "expected.json")) GTEST_SKIP() << "needs " << samples()

constexpr const char* kTicksMessage = "std_msgs/Header header\nint32 left\nint32 right\n";

class RosSample : public ::testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<LogFile> open() const {
    LogOptions options;
    options.messages = {folder_.file("WheelTicks.msg", kTicksMessage)};
    return open_ros_recording({samples() / GetParam()}, options);
  }
  testing::TemporaryFolder folder_;
};

// The paths that give a sum of expected.json.
std::vector<std::string> paths_of(const std::string& name) {
  if (name == "position" || name == "velocity")
    return {name + "[name=left_wheel_joint]", name + "[name=right_wheel_joint]",
            name + "[name=caster_joint]"};
  const std::string transforms = "transforms.";
  if (name.compare(0, transforms.size(), transforms) == 0)
    return {"transforms[header.frame_id=odom,child_frame_id=base_link]." + name.substr(transforms.size())};
  return {name};
}

TEST_P(RosSample, GivesTheSumsOfTheSimulation) {
  ODOBENCH_NEEDS_SAMPLES();
  const JsonNode topics = JsonNode::read(samples() / "expected.json").at("topics");
  std::vector<LogRequest> requests;
  std::vector<std::vector<std::size_t>> widths;
  for (const std::string& topic : topics.keys()) {
    LogRequest request;
    request.source = topic;
    std::vector<std::size_t> width;
    for (const std::string& sum : topics.at(topic).at("sums").keys()) {
      const auto paths = paths_of(sum);
      width.push_back(paths.size());
      request.fields.insert(request.fields.end(), paths.begin(), paths.end());
    }
    requests.push_back(request);
    widths.push_back(width);
  }
  const std::vector<LogTable> tables = open()->read(requests, {});
  ASSERT_EQ(tables.size(), requests.size());
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const JsonNode expected = topics.at(requests[i].source);
    const LogTable& t = tables[i];
    SCOPED_TRACE(requests[i].source);
    ASSERT_EQ(t.time_ns.size(), static_cast<std::size_t>(expected.at("count").count()));
    EXPECT_EQ(t.time_ns.front(), expected.at("first_stamp_ns").integer());
    EXPECT_EQ(t.time_ns.back(), expected.at("last_stamp_ns").integer());
    EXPECT_EQ(t.log_time_ns.front(), expected.at("first_log_ns").integer());
    EXPECT_EQ(t.log_time_ns.back(), expected.at("last_log_ns").integer());
    EXPECT_TRUE(t.notes.empty());
    std::size_t column = 0, width = 0;
    for (const std::string& name : expected.at("sums").keys()) {
      double sum = 0;
      for (std::size_t k = 0; k < widths[i][width]; ++k, ++column)
        sum = std::accumulate(t.values[column].begin(), t.values[column].end(), sum);
      ++width;
      const double wanted = expected.at("sums").at(name).number();
      EXPECT_NEAR(sum, wanted, 1e-9 * std::abs(wanted) + 1e-12) << name;
    }
  }
}

TEST_P(RosSample, ListsItsTopics) {
  ODOBENCH_NEEDS_SAMPLES();
  const JsonNode topics = JsonNode::read(samples() / "expected.json").at("topics");
  const std::vector<LogSource> sources = open()->sources({});
  EXPECT_EQ(sources.size(), topics.keys().size());
  for (const LogSource& source : sources) {
    SCOPED_TRACE(source.name);
    const JsonNode expected = topics.at(source.name);
    EXPECT_EQ(source.type, expected.at("type").text());
    EXPECT_EQ(source.unreadable, "");
    EXPECT_EQ(source.rows, expected.at("count").integer());
    EXPECT_EQ(source.first_ns, expected.at("first_log_ns").integer());
    EXPECT_EQ(source.last_ns, expected.at("last_log_ns").integer());
    ASSERT_TRUE(source.stamp_minus_log_ns.has_value());
    // The log is 2 to 10 ms late; the camera's clock is 137 ms ahead.
    const double delay = 1e-9 * static_cast<double>(*source.stamp_minus_log_ns);
    EXPECT_NEAR(delay, source.name == "/mocap/pose" ? 0.131 : -0.006, 0.005);
    std::string all;
    for (const LogField& f : source.fields) all += fmt::format("{} {} {}\n", f.path, f.type, f.first);
    const std::map<std::string, std::string> some{
        {"/joint_states", "position[name=left_wheel_joint] float64"},
        {"/tf", "transforms[header.frame_id=odom,child_frame_id=base_link].transform.rotation quaternion"},
        {"/wheel_ticks", "header.stamp time 1760000000.000234284"}};
    if (some.count(source.name) != 0) {
      EXPECT_NE(all.find(some.at(source.name)), std::string::npos) << all;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, RosSample,
                         ::testing::Values("courier_none.bag", "courier_bz2.bag", "courier_lz4.bag",
                                           "courier_none.mcap", "courier_lz4.mcap", "courier_zstd.mcap",
                                           "courier_rosbag2_plain", "courier_rosbag2_split",
                                           "courier_rosbag2_zstd_file", "courier_rosbag2_zstd_message"),
                         [](const auto& test) {
                           std::string name = test.param;
                           for (char& c : name)
                             if (c == '.') c = '_';
                           return name;
                         });

TEST(RosSamples, WithoutADefinitionSayWhatToGive) {
  ODOBENCH_NEEDS_SAMPLES();
  const auto log = open_ros_recording({samples() / "courier_rosbag2_plain"}, {});
  for (const LogSource& source : log->sources({}))
    EXPECT_EQ(source.unreadable.empty(), source.name != "/wheel_ticks") << source.unreadable;
  LogRequest ticks;
  ticks.source = "/wheel_ticks";
  ticks.fields = {"left"};
  EXPECT_TRUE(says(
      data_error([&] { log->read({ticks}, {}); }),
      {"courier_rosbag2_plain_0.db3: topic /wheel_ticks: type courier_msgs/msg/WheelTicks has no definition "
       "in this file (recorded before ROS 2 Iron): give --msg=WheelTicks.msg"}));
}

TEST(RosSamples, NameTheFieldsAndJointsThereAre) {
  ODOBENCH_NEEDS_SAMPLES();
  const auto log = open_ros_recording({samples() / "courier_none.mcap"}, {});
  LogRequest request;
  request.source = "/wheel_ticks";
  request.fields = {"lefft"};
  const auto read = [&] { log->read({request}, {}); };
  EXPECT_EQ(refusal_of<std::invalid_argument>(read),
            "no field 'lefft' in courier_msgs/WheelTicks, did you mean 'left'? it has header.stamp, "
            "header.frame_id, left, right");
  request.source = "/joint_states";
  request.fields = {"position[name=left_wheel]"};
  EXPECT_TRUE(says(data_error(read), {"no joint 'left_wheel' in 600 messages; joints: caster_joint, "
                                      "left_wheel_joint, right_wheel_joint"}));
  request.source = "/joint_state";
  EXPECT_TRUE(says(refusal_of<std::invalid_argument>(read),
                   {"no topic '/joint_state'", "did you mean '/joint_states'?", "/odom"}));
}

}  // namespace
}  // namespace odobench
