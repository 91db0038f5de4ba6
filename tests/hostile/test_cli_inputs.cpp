// What the program reads: inputs without an end, files outside a set, and text that would steer the reader's
// terminal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "reports/records/record.hpp"
#include "tests/support/data/example_runs.hpp"
#include "tests/support/formats.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::bench_words;
using testing::content;
using testing::expect_refusal;
using testing::files_below;
using testing::filter_folder;
using ::testing::HasSubstr;
using testing::kData;
using testing::kUsage;
using testing::lines;
using ::testing::Not;
using testing::Process;
using testing::ProcessResult;
using testing::run_bench;
using testing::run_folder;
using ::testing::StartsWith;
using testing::TemporaryFolder;
using testing::unprintable;
using testing::with;

// An option or place that names a file to read.
struct Reader {
  std::string name;
  std::function<std::vector<std::string>(const std::string& file)> words;
  int code = kData;
};
void PrintTo(const Reader& reader, std::ostream* out) {
  *out << reader.name;
}

const std::vector<Reader> kReaders = {
    {"data",
     [](const std::string& f) -> std::vector<std::string> {
       return {"--solver=lm", "--data=" + f};
     }},
    {"evaluate",
     [](const std::string& f) -> std::vector<std::string> {
       return {"evaluate", "--data=" + f};
     }},
    {"parameters",
     [](const std::string& f) -> std::vector<std::string> {
       return {"evaluate", "--parameters=" + f};
     }},
    {"filter",
     [](const std::string& f) -> std::vector<std::string> {
       return {"filter", "--data=" + f};
     }},
    {"truth",
     [](const std::string& f) -> std::vector<std::string> {
       return {"filter", "--data=" + filter_folder() + "/sensors.csv", "--wheel-order=left-first",
               "--truth=" + f};
     }},
    {"windows",
     [](const std::string& f) -> std::vector<std::string> {
       return {"windows", f};
     }},
    {"report",
     [](const std::string& f) -> std::vector<std::string> {
       return {"report", f};
     }},
    {"compare",
     [](const std::string& f) -> std::vector<std::string> {
       return {"compare", run_folder(), f};
     }},
    {"check",
     [](const std::string& f) -> std::vector<std::string> {
       return {"check", "--baseline=" + f, run_folder()};
     }},
    {"check_update",
     [](const std::string& f) -> std::vector<std::string> {
       return {"check", "--update", "--baseline=" + f, run_folder()};
     }},
    {"scenario",
     [](const std::string& f) -> std::vector<std::string> {
       return {"simulate", "--scenario=" + f, "--out=/nowhere/at/all"};
     }},
    {"plan",
     [](const std::string& f) -> std::vector<std::string> {
       return {"plan", "--robot=" + f};
     }},
    {"sensors",
     [](const std::string& f) -> std::vector<std::string> {
       return {"fuse", "--sensors=" + f};
     }},
    {"system",
     [](const std::string& f) -> std::vector<std::string> {
       return {"discretise", "--system=" + f, "--period=0.1"};
     }},
    {"list_data",
     [](const std::string& f) -> std::vector<std::string> {
       return {"list", "data", f};
     }},
    {"config", [](const std::string& f) -> std::vector<std::string> { return {"--config=" + f}; }, kUsage},
};

class CliReaders : public ::testing::TestWithParam<Reader> {};

TEST_P(CliReaders, InputsWithoutAnEndAreRefused) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& file, const char* what) {
    const ProcessResult result = Process(bench_words(GetParam().words(file))).wait(20);
    EXPECT_TRUE(result.exit_code == GetParam().code || result.exit_code == kUsage)
        << result.exit_code << result.err;
    EXPECT_THAT(result.err, HasSubstr(what));
    EXPECT_THAT(result.err, StartsWith("bench: error: "));
    EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
  };
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  refused((folder / "pipe").string(), "found a pipe");
  refused("/dev/zero", "found a device");
  fs::create_symlink("/dev/zero", folder / "zero");
  refused((folder / "zero").string(), GetParam().name == "check_update" ? "found a" : "found a device");
  // A file of 9 GiB that takes no room.
  const std::string large = folder.file("large", "{");
  fs::resize_file(large, 9ull << 30);
  const ProcessResult result = Process(bench_words(GetParam().words(large))).wait(60);
  EXPECT_TRUE(result.exit_code == kData || result.exit_code == kUsage) << result.exit_code << result.err;
  EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
  EXPECT_LE(result.err.size(), 1000u);
}

INSTANTIATE_TEST_SUITE_P(Every, CliReaders, ::testing::ValuesIn(kReaders),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(CliInputs, ARecordingOutsideTheSetIsNotRead) {
  const TemporaryFolder folder;
  fs::copy(source_dir() / "datasets/demo", folder / "set", fs::copy_options::recursive);
  const auto first = [&] {
    for (const auto& entry : fs::directory_iterator(folder / "set/set_recordings")) return entry.path();
    return fs::path();
  }();
  fs::rename(first, folder / "moved.rec");
  fs::create_symlink(folder / "moved.rec", first);
  expect_refusal({"evaluate", "--data=" + (folder / "set/set.json").string()}, kData,
                 {"/file: found a link to", "below the folder of the set"});
  fs::remove(first);
  fs::rename(folder / "moved.rec", folder / "set/elsewhere.rec");
  fs::create_symlink("../elsewhere.rec", first);  // inside: as some stores of large files do
  EXPECT_EQ(run_bench({"evaluate", "--data=" + (folder / "set/set.json").string()}).exit_code, 0);
  fs::remove(first);
  ASSERT_EQ(::mkfifo(first.c_str(), 0600), 0);
  expect_refusal({"evaluate", "--data=" + (folder / "set/set.json").string()}, kData, {"found a pipe"});
}

const char* const kEvil = "\x1b[31mred\x1b]0;title\x07 \u009b5m \u202eevil\x7f";

TEST(CliText, NamesFromFilesDoNotReachTheTerminalRaw) {
  const TemporaryFolder folder;
  fs::copy(source_dir() / "datasets/demo", folder / "set", fs::copy_options::recursive);
  auto set = nlohmann::json::parse(content(folder / "set/set.json"));
  set["name"] = kEvil;
  set["description"] = kEvil;
  set["notes"] = {kEvil};
  set["robot"]["name"] = kEvil;
  set["known_parameters"][0]["name"] = std::string("=cmd() ") + kEvil;
  const std::string file = folder.file("set/set.json", set.dump());
  const std::string out = (folder / "out").string();
  ASSERT_EQ(run_bench({"--solver=lm", "--data=" + file, "--out=" + out, "--quiet"}).exit_code, 0);
  for (const char* format : {"console", "md", "csv", "json", "latex"})
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"list", "data", file},
             {"report", out},
             {"evaluate", "--data=" + file, std::string("--parameters=nominal,=cmd() ") + kEvil}}) {
      const ProcessResult result = run_bench(with(words, std::string("--format=") + format));
      EXPECT_EQ(result.exit_code, 0) << result.err;
      EXPECT_FALSE(unprintable(result.out)) << words.front() << " " << format;
      EXPECT_FALSE(unprintable(result.err)) << words.front() << " " << format;
    }
  for (const std::string& name : files_below(out))
    if (name.rfind("tables.", 0) == 0) {
      EXPECT_FALSE(unprintable(content(fs::path(out) / name))) << name;
    }
  const ProcessResult csv =
      run_bench({"evaluate", "--data=" + file, std::string("--parameters==cmd() ") + kEvil, "--format=csv"});
  EXPECT_THAT(csv.out, HasSubstr("'=cmd()"));
  EXPECT_THAT(csv.out, Not(HasSubstr(",=cmd()")));
}

TEST(CliText, MessagesQuoteAtMostALittleAndNothingRaw) {
  const TemporaryFolder folder;
  const std::string million(1 << 20, 'x');
  const std::string bad = std::string("\xff\xfe") + kEvil;
  const std::vector<std::vector<std::string>> cases = {
      {"filter", "--data=" + folder.file("a.csv", million + "," + bad + "\n1,2\n")},
      {"filter", "--data=" + folder.file("b.csv", "time_s,enc1_m\n" + million + "," + bad + "\n")},
      {"filter", "--data=" + folder.file("c.csv", bad)},
      {"evaluate", "--data=" + folder.file("a.json", "{\"" + million + "\": 1}")},
      {"evaluate", "--data=" + folder.file("b.json", "{\"schema\": \"" + million + "\"}")},
      {"evaluate", "--data=" + folder.file("c.json", bad)},
      {"evaluate", "--data=" + folder.file("d.json", "{\"schema\": \"" + bad + "\"}")},
      {"evaluate", "--parameters=" + folder.file("e.json", "{\"" + million + "\": 1}")},
      {"evaluate", "--parameters=" + folder.file("f.json", "{\"a1\": \"" + million + "\"}")},
      {"evaluate", "--parameters=" + million.substr(0, 100000)},
      {"--config=" + folder.file("a.ini", million)},
      {"--config=" + folder.file("b.ini", bad + "=1\n")},
      {"--config=" + folder.file("c.ini", "[" + million + "]\n")},
      {"--config=" + folder.file("d.ini", million + " = 1\n")},
      {"--config=" + folder.file("e.json", "{\"" + million + "\": 1}")},
      {"report", folder.file("runs.jsonl", million + "\n")},
      {"report", folder.file("runs2.jsonl", "{\"" + million + "\": 1}\n")},
      {"report", folder.file("runs3.jsonl", bad + "\n")},
      {"check", "--baseline=" + folder.file("base.json", "{\"" + million + "\": 1}"), run_folder()},
      {"windows", folder.file("w.json", "{\"format\": \"" + million + "\"}")},
      {"fuse", "--sensors=" + folder.file("s.json", "{\"" + million + "\": 1}")},
      {"discretise", "--period=1", "--system=" + folder.file("sys.json", "{\"" + million + "\": 1}")},
      {"simulate", "--scenario=" + folder.file("sc.json", "{\"" + million + "\": 1}"),
       "--out=/nowhere/at/all"},
      {"simulate", "--scenario=" + bad, "--out=/nowhere/at/all"},
      {"--solver=" + bad},
      {"--" + bad},
      {bad},
      {million.substr(0, 100000)},
      {"evaluate", "--data=" + bad},
      {"list", "data", folder.file(std::string("evil\x1b[31m\nname") + ".json", "{}")},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const ProcessResult result = Process(bench_words(cases[i])).wait(60);
    SCOPED_TRACE(cases[i].front().substr(0, 40) + " " + std::to_string(i));
    EXPECT_TRUE(result.exit_code == kUsage || result.exit_code == kData) << result.exit_code;
    EXPECT_EQ(lines(result.err).size(), 1u);
    EXPECT_LE(result.err.size(), 2100u);
    EXPECT_FALSE(unprintable(result.err)) << result.err;
  }
}

}  // namespace
}  // namespace odobench
