// Every verb that writes, with each of its file operations failing once: a full disc, an input/output error,
// a name that cannot be given, a process that is killed there. What is on disc afterwards is whole, and
// nothing else is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <thread>

#include "reports/records/record.hpp"
#include "tests/support/data/entropy_windows.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::bench_words;
using testing::content;
using testing::files_below;
using testing::lines;
using testing::Process;
using testing::ProcessResult;
using ::testing::StartsWith;
using testing::TemporaryFolder;

struct Verb {
  std::string name;
  std::function<std::vector<std::string>(const std::string& out)> words;
  bool records = false;  // appends to runs.jsonl, which is useful without the rest
};
void PrintTo(const Verb& verb, std::ostream* out) {
  *out << verb.name;
}

// Inputs of some verbs, made when the first of them asks: CTest runs every test in a process of its own.
std::string made(const char* name, const std::vector<std::string>& words) {
  static const TemporaryFolder folder;
  const std::string path = (folder / name).string();
  if (!fs::exists(path)) {
    std::vector<std::string> all = words;
    all.push_back("--out=" + path);
    EXPECT_EQ(testing::run_bench(all).exit_code, 0);
  }
  return path;
}
std::string stored_run() {
  return made("run", {"--solver=lm", "--quiet"});
}
std::string drive() {
  return made("drive", {"simulate", "--scenario=filter_run"});
}
std::string raw_files() {
  return made("raw", {"simulate", "--scenario=vitko2024", "--raw", "--quiet"});
}
std::string windows_file() {
  static const TemporaryFolder folder;
  return folder.file("windows.json", testing::windows_json());
}

using Words = std::vector<std::string>;
const std::vector<Verb> kVerbs = {
    {"run",
     [](const std::string& out) -> Words {
       return {"--solver=lm,ga", "--repeat=3", "--max-evals=300", "--threads=1", "--quiet", "--out=" + out};
     },
     true},
    {"windows",
     [](const std::string& out) -> Words {
       return {"windows", windows_file(), "--solver=coordinate", "--quiet", "--out=" + out};
     },
     true},
    {"evaluate",
     [](const std::string& out) -> Words {
       return {"evaluate", "--out=" + out};
     },
     true},
    {"fuse",
     [](const std::string& out) -> Words {
       return {"fuse", "--sensors=" + (source_dir() / "datasets/sensors/heading_only.json").string(),
               "--filter=ekf", "--out=" + out};
     },
     true},
    {"plan",
     [](const std::string& out) -> Words {
       return {"plan", "--robot=exact", "--threads=1", "--out=" + out};
     },
     true},
    {"tracks",
     [](const std::string& out) -> Words {
       return {"evaluate", "--tracks=" + out + "/tracks.csv"};
     }},
    {"filter",
     [](const std::string& out) -> Words {
       return {"filter", "--data=" + drive() + "/sensors.csv", "--wheel-order=left-first", "--quiet",
               "--out=" + out + "/filtered.csv"};
     }},
    {"report",
     [](const std::string& out) -> Words {
       return {"report", stored_run(), "--out=" + out + "/r.html"};
     }},
    {"export",
     [](const std::string& out) -> Words {
       return {"export", stored_run(), "--tum", "--out=" + out};
     }},
    {"check",
     [](const std::string& out) -> Words {
       return {"check", "--update", "--baseline=" + out + "/base.json", stored_run()};
     }},
    {"demo",
     [](const std::string& out) -> Words {
       return {"demo", "--out=" + out};
     }},
    {"import",
     [](const std::string& out) -> Words {
       return {"import", "vitko2024", "--from=" + raw_files(), "--quiet", "--out=" + out + "/set.json"};
     }},
    {"simulate",
     [](const std::string& out) -> Words {
       return {"simulate", "--scenario=exact", "--out=" + out};
     }},
    {"simulate_dynamics",
     [](const std::string& out) -> Words {
       return {"simulate", "--scenario=filter_run", "--out=" + out};
     }},
};

struct Effect {
  const char* call;
  std::string effect;
};
const std::vector<Effect> kEffects = {
    {"open", std::to_string(ENOSPC)},  {"write", std::to_string(EIO)},     {"write", "short"},
    {"close", std::to_string(EIO)},    {"rename", std::to_string(EACCES)}, {"mkdir", std::to_string(ENOSPC)},
    {"ftruncate", std::to_string(EIO)}};

bool has_temporary(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (name.find(".tmp-") != std::string::npos) return true;
  return false;
}

class CliFaults : public ::testing::TestWithParam<Verb> {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers want to be loaded first";
#endif
    ASSERT_TRUE(fs::exists(ODOBENCH_FAULT_SHIM));
    const ProcessResult result = Process(bench_words(words(folder_ / "whole", false))).wait();
    ASSERT_EQ(result.exit_code, 0) << result.err;
    whole_ = files_below(folder_ / "whole");
  }

  Words words(const fs::path& out, bool overwrite) const {
    Words words = GetParam().words(out.string());
    if (overwrite) words.push_back("--overwrite");
    if (GetParam().name == "check" && overwrite) words.pop_back();
    return words;
  }

  // Ends the loop over the operations: false when there was no such operation any more.
  bool run(const Effect& effect, int n, const fs::path& out, ProcessResult& result, bool overwrite = false) {
    const fs::path mark = folder_ / "mark";
    fs::remove(mark);
    result = Process(bench_words(words(out, overwrite)), {std::string("LD_PRELOAD=") + ODOBENCH_FAULT_SHIM,
                                                          "ODOBENCH_FAULT_MARK=" + mark.string(),
                                                          std::string("ODOBENCH_FAULT=") + effect.call + ":" +
                                                              std::to_string(n) + ":" + effect.effect})
                 .wait();
    return fs::exists(mark);
  }

  // Every line of the records is whole.
  void expect_whole_records(const fs::path& out) const {
    if (!fs::exists(out / "runs.jsonl")) return;
    const std::string text = content(out / "runs.jsonl");
    EXPECT_TRUE(text.empty() || text.back() == '\n');
    EXPECT_NO_THROW(read_records((out / "runs.jsonl").string()));
  }

  TemporaryFolder folder_;
  std::vector<std::string> whole_;
};

TEST_P(CliFaults, AnOperationThatFailsIsSaidAndLeavesNothingPartial) {
  int faults = 0;
  for (const Effect& effect : kEffects)
    for (int n = 1; n < 40; n *= 2) {
      const fs::path out = folder_ / "out";
      fs::remove_all(out);
      ProcessResult result;
      if (!run(effect, n, out, result)) break;
      ++faults;
      SCOPED_TRACE(std::string(effect.call) + " " + std::to_string(n) + " " + effect.effect + ": " +
                   result.err);
      ASSERT_EQ(result.signal, 0);
      const std::vector<std::string> names = files_below(out);
      EXPECT_FALSE(has_temporary(names)) << ::testing::PrintToString(names);
      expect_whole_records(out);
      if (result.exit_code == 0) {
        EXPECT_EQ(names, whole_);
        continue;
      }
      EXPECT_TRUE(result.exit_code == 2 || result.exit_code == 3) << result.exit_code;
      ASSERT_FALSE(lines(result.err).empty());
      EXPECT_THAT(lines(result.err).back(), StartsWith("bench: error: "));
      if (!GetParam().records) {
        EXPECT_FALSE(fs::exists(out)) << ::testing::PrintToString(names);
      }
    }
  EXPECT_GT(faults, 4);
}

// Of verbs whose files belong together; records are replaced from the beginning.
class CliFaultsOfSets : public CliFaults {};

TEST_P(CliFaultsOfSets, OlderFilesComeBackWhenNewOnesFail) {
  const fs::path out = folder_ / "out";
  for (const Effect& effect : kEffects)
    for (int n = 1; n < 40; n *= 2) {
      fs::remove_all(out);
      fs::copy(folder_ / "whole", out, fs::copy_options::recursive);
      for (const std::string& name : whole_)
        if (fs::is_regular_file(out / name)) fs::resize_file(out / name, 3);
      if (GetParam().name == "check") fs::remove(out / "base.json");
      ProcessResult result;
      if (!run(effect, n, out, result, true)) break;
      SCOPED_TRACE(std::string(effect.call) + " " + std::to_string(n) + " " + effect.effect + ": " +
                   result.err);
      EXPECT_FALSE(has_temporary(files_below(out)));
      std::size_t old = 0, fresh = 0;
      for (const std::string& name : files_below(out))
        if (fs::is_regular_file(out / name)) ++(fs::file_size(out / name) == 3 ? old : fresh);
      EXPECT_TRUE(old == 0 || fresh == 0) << old << " old, " << fresh << " new";
      EXPECT_EQ(result.exit_code == 0, old == 0 && fresh > 0);
    }
}

TEST_P(CliFaults, AKilledProcessLeavesWholeFilesAndANewOneMakesTheRest) {
  for (const char* call : {"open", "write", "rename"})
    for (int n = 1; n < 40; n *= 2) {
      const fs::path out = folder_ / "out";
      fs::remove_all(out);
      ProcessResult result;
      if (!run({call, "kill"}, n, out, result)) break;
      SCOPED_TRACE(std::string(call) + " " + std::to_string(n));
      ASSERT_EQ(result.signal, SIGKILL);
      expect_whole_records(out);
      const ProcessResult again = Process(bench_words(words(out, GetParam().name != "check"))).wait();
      EXPECT_EQ(again.exit_code, 0) << again.err;
      std::vector<std::string> names;
      for (const std::string& name : files_below(out))
        if (name.find(".tmp-") == std::string::npos) names.push_back(name);
      EXPECT_EQ(names, whole_);
    }
}

// Whatever the moment: what is complete is kept and said, the rest is not there.
TEST_P(CliFaults, ASignalAtAnyMomentLosesNothing) {
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(Process(bench_words(words(folder_ / "timed", false))).wait().exit_code, 0);
  const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begin;
  const char* const asked = std::getenv("ODOBENCH_MOMENTS");
  const int moments = asked == nullptr ? 3 : std::atoi(asked);
  for (const int signal : {SIGTERM, SIGHUP, SIGINT, SIGKILL})
    for (int i = 0; i < moments; ++i) {
      const fs::path out = folder_ / "out";
      fs::remove_all(out);
      Process process(bench_words(words(out, false)));
      std::this_thread::sleep_for(whole * (0.1 + i) / moments);
      process.send(signal);
      const ProcessResult result = process.wait();
      SCOPED_TRACE("signal " + std::to_string(signal) + " at " + std::to_string(i) + ": " + result.err);
      expect_whole_records(out);
      const std::vector<std::string> names = files_below(out);
      if (signal == SIGKILL) {
        EXPECT_TRUE(result.signal == SIGKILL || result.exit_code == 0) << result.exit_code;
        EXPECT_EQ(Process(bench_words(words(out, GetParam().name != "check"))).wait().exit_code, 0);
        continue;
      }
      // Before main() a signal has its default effect.
      const bool early = result.signal == signal && names.empty();
      EXPECT_TRUE(early || result.exit_code == 0 || result.exit_code == 130)
          << result.signal << " " << result.exit_code;
      EXPECT_FALSE(has_temporary(names));
      if (result.exit_code == 0) {
        EXPECT_EQ(names, whole_);
      }
      if (result.exit_code == 130 && !GetParam().records && GetParam().name != "filter") {
        EXPECT_TRUE(names.empty() || names == whole_) << ::testing::PrintToString(names);
      }
      if (result.exit_code == 130 && fs::exists(out / "runs.jsonl")) {
        EXPECT_TRUE(fs::exists(out / "tables.json"));
      }
    }
}

std::vector<Verb> verbs_of_sets() {
  std::vector<Verb> list;
  for (const Verb& verb : kVerbs)
    if (!verb.records) list.push_back(verb);
  return list;
}

INSTANTIATE_TEST_SUITE_P(Every, CliFaultsOfSets, ::testing::ValuesIn(verbs_of_sets()),
                         [](const auto& parameter) { return parameter.param.name; });
INSTANTIATE_TEST_SUITE_P(Every, CliFaults, ::testing::ValuesIn(kVerbs),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace odobench
