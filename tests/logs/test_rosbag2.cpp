#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/logs/ros/ros_logs.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/small_log.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::data_error;
using testing::expect_small_log;
using testing::run_sql;
using testing::says;
using testing::write_rosbag2;

const testing::WrittenLog& log_of_ros2() {
  static const testing::WrittenLog log = testing::small_log(RosEncoding::Cdr);
  return log;
}

class Rosbag2 : public ::testing::Test {
 protected:
  fs::path file(const testing::Rosbag2Options& options = {}, const std::string& name = "run_0.db3") const {
    write_rosbag2(folder_ / name, log_of_ros2(), options);
    return folder_ / name;
  }
  std::string refusal(const fs::path& file) const {
    return data_error([&] { open_ros_recording({file}, {})->read(testing::small_log_requests(), {}); });
  }
  testing::TemporaryFolder folder_;
};

TEST_F(Rosbag2, IsReadPlainAndCompressed) {
  expect_small_log(*open_ros_recording({file()}, {}));
  testing::Rosbag2Options options;
  options.compress_messages = true;
  expect_small_log(*open_ros_recording({file(options, "messages.db3")}, {}));
  const std::string whole = testing::compressed("zstd", testing::content(folder_ / "run_0.db3"));
  expect_small_log(*open_ros_recording({folder_.file("odd ?#%name.db3.zstd", whole)}, {}));
  fs::copy_file(folder_ / "run_0.db3", folder_ / "odd ?#%name.db3");
  expect_small_log(*open_ros_recording({folder_ / "odd ?#%name.db3"}, {}));
  EXPECT_TRUE(says(refusal(folder_.file("cut.db3.zstd", whole.substr(0, whole.size() / 2))), {"end early"}));
}

TEST_F(Rosbag2, NothingIsWrittenBesideIt) {
  const fs::path db = file();
  run_sql(db, "PRAGMA journal_mode=WAL;");
  const auto before = testing::files_below(folder_.path());
  const std::string bytes = testing::content(db);
  expect_small_log(*open_ros_recording({db}, {}));
  EXPECT_EQ(testing::files_below(folder_.path()), before);
  EXPECT_EQ(testing::content(db), bytes);
}

TEST_F(Rosbag2, WarnsOfMessagesThatAreNotInTheFile) {
  const fs::path db = file();
  folder_.file("run_0.db3-wal", "something");
  const auto tables = open_ros_recording({db}, {})->read(testing::small_log_requests(), {});
  EXPECT_THAT(tables[0].notes,
              ::testing::ElementsAre(::testing::HasSubstr("run_0.db3-wal: its messages are missing here")));
}

TEST_F(Rosbag2, FilesOfAFolderComeInTheOrderOfTheirNumbers) {
  // _10 after _9, and one of them an MCAP file.
  for (int part = 8; part <= 10; ++part) {
    testing::WrittenLog some = log_of_ros2();
    some.messages.assign(log_of_ros2().messages.begin() + 30 * (part - 8),
                         log_of_ros2().messages.begin() + 30 * (part - 7));
    const std::string name = "run_" + std::to_string(part);
    if (part == 9)
      folder_.file(name + ".mcap", testing::mcap_bytes(some));
    else
      write_rosbag2(folder_ / (name + ".db3"), some);
  }
  folder_.file("metadata.yaml", "rosbag2_bagfile_information:\n");
  expect_small_log(*open_ros_recording({folder_.path()}, {}));
  expect_small_log(
      *open_ros_recording({folder_ / "run_8.db3", folder_ / "run_9.mcap", folder_ / "run_10.db3"}, {}));
  int formats = 0;
  for (const LogFormat& format : ros_log_formats()) formats += format.recognises(folder_.path(), "") ? 1 : 0;
  EXPECT_EQ(formats, 1);
}

TEST_F(Rosbag2, StandardMessagesNeedNoDefinition) {
  testing::Rosbag2Options options;
  options.definitions = false;
  const fs::path db = file(options);
  EXPECT_TRUE(
      says(refusal(db), {"run_0.db3: topic /ticks: type test_msgs/msg/Ticks has no definition in this file "
                         "(recorded before ROS 2 Iron): give --msg=Ticks.msg"}));
  LogOptions given;
  given.messages = {folder_.file(
      "Ticks.msg",
      "# a type of our own\nstd_msgs/Header header # when\nint32 LIMIT=5\nint32 left\nint32 right 7\n")};
  const auto log = open_ros_recording({db}, given);
  expect_small_log(*log);
  for (const LogSource& source : log->sources({})) EXPECT_EQ(source.unreadable, "");
}

TEST_F(Rosbag2, TablesMustBeTables) {
  const fs::path db = file();
  run_sql(db,
          "ALTER TABLE messages RENAME TO m; CREATE VIEW messages AS WITH RECURSIVE r(id, topic_id, "
          "timestamp, data) AS "
          "(SELECT 1, 1, 1, x'00' UNION ALL SELECT id + 1, 1, 1, x'00' FROM r) SELECT * FROM r;");
  EXPECT_TRUE(says(refusal(db), {"run_0.db3: 'messages' is a view, expected a table"}));
  const fs::path none = folder_ / "none.db3";
  run_sql(none, "CREATE TABLE a(b);");
  EXPECT_TRUE(says(refusal(none), {"none.db3: found other tables, expected rosbag2's topics and messages"}));
  const fs::path columns = folder_ / "columns.db3";
  run_sql(columns, "CREATE TABLE topics(id); CREATE TABLE messages(id);");
  EXPECT_TRUE(says(refusal(columns), {"columns.db3: SQLite: no such column"}));
}

TEST_F(Rosbag2, DamagedMessagesAreRefused) {
  const fs::path db = file();
  run_sql(db, "UPDATE messages SET data = x'00010000' WHERE id = 4;");
  EXPECT_TRUE(
      says(refusal(db), {"run_0.db3: message 4: topic /ticks: does not fit test_msgs/Ticks: found 0 bytes"}));
  run_sql(db, "UPDATE messages SET data = x'28b52ffd0000' WHERE id = 4;");
  EXPECT_TRUE(says(refusal(db), {"run_0.db3: message 4: "}));
  run_sql(db, "UPDATE messages SET data = x'0003000000' WHERE id = 4;");
  EXPECT_TRUE(says(refusal(db), {"encapsulation 00 03"}));
  run_sql(db, "UPDATE topics SET serialization_format = 'protobuf';");
  EXPECT_TRUE(says(refusal(db), {"serialised as 'protobuf', expected cdr"}));
}

TEST_F(Rosbag2, StopsWhenAsked) {
  const std::atomic<bool> stop{true};
  const auto log = open_ros_recording({file()}, {});
  EXPECT_THROW(log->read(testing::small_log_requests(), Stop(stop)), Interruption);
}

}  // namespace
}  // namespace odobench
