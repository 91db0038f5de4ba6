// Logs as other programs write them, through the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.hpp"
#include "tests/support/data/filter_run_files.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using testing::plain_run;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

TEST(CliCsv, EveryDialectGivesTheSameNumbers) {
  const TemporaryFolder folder;
  const std::string plain = plain_run(40);
  const auto filtered = [&](const std::string& text) {
    const std::string data = folder.file("run.csv", text), out = (folder / "out.csv").string();
    const ProcessResult run =
        run_bench({"filter", "--quiet", "--data=" + data, "--out=" + out, "--overwrite"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return read_file(out);
  };
  const std::string wanted = filtered(plain);
  const auto with = [&](const std::string& comma, const std::string& point, const std::string& end) {
    std::string text;
    for (const char c : plain)
      text += c == ',' ? comma : c == '.' ? point : c == '\n' ? end : std::string(1, c);
    return text;
  };
  EXPECT_EQ(filtered(with(";", ",", "\n")), wanted);
  EXPECT_EQ(filtered("\xEF\xBB\xBF" + with(";", ".", "\r\n")), wanted);
  EXPECT_EQ(filtered("sep=\t\n" + with("\t", ",", "\n")), wanted);
  EXPECT_EQ(filtered(with(", ", ".", "\n")), wanted);
  EXPECT_EQ(filtered("# a robot's log\n" + plain.substr(0, plain.size() - 1)), wanted);
}

// It may have been cut, so it is said.
TEST(CliCsv, ALastLineWithoutABreakIsSaid) {
  const TemporaryFolder folder;
  const std::string plain = plain_run(40);
  const ProcessResult whole = run_bench({"filter", "--data=" + folder.file("whole.csv", plain)});
  const ProcessResult cut =
      run_bench({"filter", "--data=" + folder.file("cut.csv", plain.substr(0, plain.size() - 1))});
  EXPECT_EQ(cut.exit_code, 0) << cut.err;
  EXPECT_THAT(cut.err, ::testing::HasSubstr("the last line has no line break"));
  EXPECT_THAT(whole.err, ::testing::Not(::testing::HasSubstr("line break")));
}

}  // namespace
}  // namespace odobench
