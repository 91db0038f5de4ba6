// scripts/optiodom_table.py on OptiOdom's data: every number agrees with the published cells as far as the
// page's words go, J is at the independent minimum, and a number that is off is noticed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/data/optiodom.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

// The reference, of four sets of the four kinds of robots.
json some_sets() {
  json sets;
  for (const char* name : {"diff/square/230620202042", "tricyc/square/140120211430",
                           "omni3/joystick/211220201842", "omni4/circular/231220200510"})
    sets[name] = optiodom_reference().at(name);
  return sets;
}

ProcessResult script(const TemporaryFolder& folder, const json& sets) {
  folder.file("robots.json", sets.dump());
  folder.file("robots_extras.json", optiodom_reference("robots_extras.json").dump());
  return Process({"/usr/bin/env", "python3", (source_dir() / "scripts/optiodom_table.py").string(),
                  bench_words({}).front(), optiodom_folder().string(), folder.path().string()})
      .wait(300);
}

bool has_python() {
  return Process({"/bin/sh", "-c", "command -v python3"}).wait().exit_code == 0;
}

TEST(OptiodomScript, AgreesWithPublishedCells) {
  ODOBENCH_NEEDS_OPTIODOM();
  if (!has_python()) GTEST_SKIP() << "needs python3";
  const TemporaryFolder folder;
  const ProcessResult run = script(folder, some_sets());
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, HasSubstr("| **diff/square/230620202042** (6 drives) |"));
  EXPECT_THAT(run.out, HasSubstr("| lin | "));
  EXPECT_THAT(run.out, HasSubstr("**ours**, lm from nominal"));
  // The words that the committed page has, so that it is not older than its source.
  const std::string words = content(source_dir() / "scripts/optiodom_words.md");
  const std::string page = content(source_dir() / "docs/optiodom.md");
  EXPECT_EQ(page.substr(0, page.find("\n| ")), words.substr(0, words.find("\n<!-- table -->")));
}

TEST(OptiodomScript, NoticesWhatIsOff) {
  ODOBENCH_NEEDS_OPTIODOM();
  if (!has_python()) GTEST_SKIP() << "needs python3";
  const std::string folder_name = "tricyc/square/140120211430";
  json sets{{folder_name, optiodom_reference().at(folder_name)}};
  json& cell = sets[folder_name]["published"]["kallasi"]["table"]["max_position_m"];
  cell = cell.get<double>() + 2e-6;
  json& star = sets[folder_name]["problems"]["optiodom"]["optimum"]["J"];
  star = star.get<double>() * (1 - 1e-6);
  const TemporaryFolder folder;
  const ProcessResult run = script(folder, sets);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("tricyc/square/140120211430, classical:kallasi"));
  EXPECT_THAT(run.err, HasSubstr("tricyc/square/140120211430: J 0.116"));
}

}  // namespace
}  // namespace odobench::testing
