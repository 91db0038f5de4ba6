// scripts/fetch_vitko2024.sh against small local repositories: a copy of the script beside other sums fetches
// other files.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "base/files.hpp"
#include "base/sha256.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::Process;
using testing::ProcessResult;

class FetchScript : public ::testing::Test {
 protected:
  void SetUp() override {
    if (shell("command -v git sha256sum").exit_code != 0) GTEST_SKIP() << "needs git and sha256sum";
    fs::create_directories(root_ / "scripts");
    fs::copy_file(source_dir() / "scripts/fetch_vitko2024.sh", root_ / "scripts/fetch_vitko2024.sh");
    write_file(root_ / "scripts/vitko2024.sha256",
               sha256("one\n") + "  abs_1.csv\n" + sha256("two\n") + "  odom_1.csv\n");
    write_file(root_ / "origin/dataset/abs_1.csv", "one\n");
    write_file(root_ / "origin/dataset/odom_1.csv", "two\n");
    write_file(root_ / "origin/dataset/more.txt", "not asked for\n");
    commit_ = commit("git init --quiet .");
  }
  static ProcessResult shell(const std::string& command) {
    return Process({"/bin/sh", "-c", command}).wait();
  }
  std::string commit(const std::string& before) const {
    const std::string who = "git -c user.name=t -c user.email=t@example.org -c commit.gpgsign=false ";
    const ProcessResult r = shell("cd '" + (root_ / "origin").string() + "' && " + before +
                                  " && git add -A && " + who + "commit --quiet -m x && git rev-parse HEAD");
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return r.out.substr(0, r.out.find('\n'));
  }
  ProcessResult fetch(const std::string& arguments = "", const std::string& commit = "",
                      const std::string& url = "") const {
    return shell("ODOBENCH_VITKO2024_URL='" + (url.empty() ? (root_ / "origin").string() : url) +
                 "' ODOBENCH_VITKO2024_COMMIT='" + (commit.empty() ? commit_ : commit) + "' bash '" +
                 (root_ / "scripts/fetch_vitko2024.sh").string() + "' " + arguments);
  }
  // Nothing but the folder asked for, if that, in data/.
  std::size_t entries_in_data() const {
    std::size_t n = 0;
    if (fs::exists(root_ / "data"))
      for ([[maybe_unused]] const auto& entry : fs::directory_iterator(root_ / "data")) ++n;
    return n;
  }

  testing::TemporaryFolder root_;
  std::string commit_;
};

TEST_F(FetchScript, FetchesOnceAndThenHasNothingToDo) {
  const ProcessResult first = fetch();
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("2 files, all sums right"), std::string::npos) << first.out;
  const fs::path target = root_ / "data/vitko2024";
  EXPECT_EQ(read_file(target / "abs_1.csv"), "one\n");
  EXPECT_EQ(read_file(target / "odom_1.csv"), "two\n");
  EXPECT_EQ(read_file(target / "SHA256SUMS"), read_file(root_ / "scripts/vitko2024.sha256"));
  EXPECT_FALSE(fs::exists(target / "more.txt"));
  EXPECT_EQ(entries_in_data(), 1u);
  const ProcessResult again = fetch("", "", "/nonexistent");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.out.find("complete, nothing to do"), std::string::npos) << again.out;
}

TEST_F(FetchScript, FillsAnEmptyFolderButNeverReplacesFiles) {
  fs::create_directories(root_ / "mine");
  const std::string mine = "'" + (root_ / "mine").string() + "'";
  EXPECT_EQ(fetch(mine).exit_code, 0);
  write_file(root_ / "mine/abs_1.csv", "changed\n");
  const ProcessResult changed = fetch(mine);
  EXPECT_EQ(changed.exit_code, 1);
  EXPECT_NE(changed.err.find("1 of 2 differ"), std::string::npos) << changed.err;
  EXPECT_EQ(read_file(root_ / "mine/abs_1.csv"), "changed\n");
}

TEST_F(FetchScript, LeavesNothingWhenItFails) {
  const ProcessResult unreachable = fetch("", "", "/nonexistent");
  EXPECT_EQ(unreachable.exit_code, 1);
  EXPECT_NE(unreachable.err.find("cannot clone /nonexistent"), std::string::npos) << unreachable.err;
  const ProcessResult no_commit = fetch("", std::string(40, '1'));
  EXPECT_EQ(no_commit.exit_code, 1);
  EXPECT_NE(no_commit.err.find("no folder dataset/ at commit 1111"), std::string::npos) << no_commit.err;
  write_file(root_ / "origin/dataset/odom_1.csv", "other\n");
  const ProcessResult other = fetch("", commit("true"));
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("odom_1.csv: FAILED"), std::string::npos) << other.err;
  EXPECT_EQ(entries_in_data(), 0u);
  EXPECT_EQ(fetch().exit_code, 0) << "the earlier commit is still right";
}

TEST_F(FetchScript, RefusesWrongUsage) {
  EXPECT_EQ(fetch("a b").exit_code, 2);
  EXPECT_EQ(fetch("--form=x").exit_code, 2);
  EXPECT_EQ(fetch("--help").exit_code, 0);
  EXPECT_EQ(entries_in_data(), 0u);
}

}  // namespace
}  // namespace odobench
