// Every command of docs/calibrate.md, one after the other as a reader would type them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench::testing {
namespace {

using ::testing::HasSubstr;

// What stands in blocks of the page that begin with ```sh, a line each.
std::vector<std::string> commands_of(const std::string& page) {
  std::vector<std::string> commands;
  bool inside = false;
  for (const std::string& line : lines(content(source_dir() / "docs" / page))) {
    if (line.starts_with("```"))
      inside = line == "```sh";
    else if (inside)
      commands.push_back(line);
  }
  return commands;
}

TEST(Tutorial, EveryCommandOfThePageWorks) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "datasets/samples");
  std::filesystem::copy_file(source_dir() / "datasets/samples/courier.bag",
                             folder / "datasets/samples/courier.bag");
  const std::string bench = std::filesystem::path(bench_words({}).front()).parent_path().string();
  std::string all;
  const std::vector<std::string> commands = commands_of("calibrate.md");
  ASSERT_GE(commands.size(), 5U);
  for (const std::string& command : commands) {
    const ProcessResult run =
        Process({"/bin/sh", "-c",
                 "cd '" + folder.path().string() + "' && PATH='" + bench + "':$PATH && " + command})
            .wait(60);
    ASSERT_EQ(run.exit_code, 0) << command << "\n" << run.err;
    all += run.out + run.err;
  }
  // The figures that the page shows.
  for (const char* figure : {"411.995   49.848  50.396", "runs 0.13704 s ahead",
                             "x = 30.01 mm, y = -12.00 mm", "the robot's own odometry is no reference"})
    EXPECT_THAT(all, HasSubstr(figure));
}

}  // namespace
}  // namespace odobench::testing
