// A table of hostile inputs: what a user's file may hold, the exit code, what the one line says.
// tests/hostile/cases.json is the table: in an example of `format` the first `from` becomes `to` (without
// `from` the whole file does), each character up to U+00FF standing for a byte.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/formats.hpp"
#include "tests/support/in_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench::testing {
namespace {

using nlohmann::json;

std::string bytes_of(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto lead = static_cast<unsigned char>(text[i]);
    if (lead < 0x80) {
      bytes += text[i];
    } else {
      bytes += static_cast<char>(((lead & 3) << 6) | (static_cast<unsigned char>(text[i + 1]) & 0x3F));
      ++i;
    }
  }
  return bytes;
}

// The input of a case; "" `applied` when no example has its `from`.
std::string input_of(const json& one, bool& applied) {
  const std::string from = bytes_of(one.at("from")), to = bytes_of(one.at("to"));
  applied = true;
  if (from.empty()) return to;
  for (std::string example : format_called(one.at("format")).examples())
    if (const auto at = example.find(from); at != std::string::npos)
      return example.replace(at, from.size(), to);
  applied = false;
  return "";
}

// One line without what changes from run to run.
std::string without_folder(std::string text, const TemporaryFolder& folder) {
  const std::string path = folder.path().string() + "/";
  for (std::size_t at; (at = text.find(path)) != std::string::npos;) text.erase(at, path.size());
  return text;
}

class CliHostile : public ::testing::TestWithParam<std::string> {};

TEST_P(CliHostile, EveryInputHasItsCodeAndItsLine) {
  const json cases = json::parse(content(source_dir() / "tests/hostile/cases.json"));
  // Writes the table anew, to be looked through before it is committed.
  const char* const record = std::getenv("ODOBENCH_RECORD_HOSTILE");
  std::size_t count = 0;
  for (const json& one : cases) {
    if (one.at("format") != GetParam()) continue;
    ++count;
    SCOPED_TRACE(one.dump(-1, ' ', true));
    bool applied = false;
    const std::string bytes = input_of(one, applied);
    EXPECT_TRUE(applied) << "no example has this text";
    if (!applied) continue;
    const TemporaryFolder folder;
    for (const Words& words : format_called(GetParam()).commands(bytes, folder)) {
      const ProcessResult result = bench_in_process(words);
      EXPECT_EQ(complaint_about(result, folder, bytes, format_called(GetParam()).binary), "") << result.err;
      const std::string said = without_folder(result.err, folder);
      if (record != nullptr) {
        json now = one;
        now["code"] = result.exit_code;
        now["says"] = said;
        std::ofstream(record, std::ios::app) << now.dump(-1, ' ', true) << "\n";
      } else {
        EXPECT_EQ(result.exit_code, one.at("code").get<int>()) << said;
        EXPECT_THAT(said, ::testing::HasSubstr(one.at("says").get<std::string>()));
      }
      break;  // the others read the same file
    }
  }
  EXPECT_GE(count, 5u);
}

INSTANTIATE_TEST_SUITE_P(Every, CliHostile, ::testing::ValuesIn(format_names()),
                         [](const auto& parameter) { return parameter.param; });

}  // namespace
}  // namespace odobench::testing
