// Five hundred damaged files of every format that the program reads: each ends with a result or with one
// clear line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/support/formats.hpp"
#include "tests/support/in_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench::testing {
namespace {

namespace fs = std::filesystem;

// One to three damages: flipped bits, bytes, numbers that overflow, pieces lost or doubled.
std::string damaged(std::string text, std::mt19937_64& random) {
  static const std::vector<std::string> pieces = {"1e308", "-1e308",
                                                  "1e309", "1e-320",
                                                  "0",     "-1",
                                                  "nan",   "inf",
                                                  "null",  "\"",
                                                  "{",     "[",
                                                  "]",     ",",
                                                  ";",     "\n",
                                                  "\r",    "\xff",
                                                  "\x1b[", "\u202e",
                                                  "1e9",   "99999999999999999999",
                                                  "\"\"",  "[]",
                                                  "{}",    std::string(1, '\0')};
  const auto below = [&random](std::size_t n) {
    return static_cast<std::size_t>(random() % std::max<std::size_t>(n, 1));
  };
  for (std::size_t times = 1 + below(3); times > 0; --times) {
    const std::size_t at = below(text.size() + 1), length = 1 + below(1 + below(40));
    switch (below(6)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      case 2:
        if (at < text.size()) text.erase(at, length);
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      case 4: {  // a number becomes another one
        const std::size_t digit = text.find_first_of("0123456789", at);
        if (digit == std::string::npos) break;
        const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", digit), text.size());
        text.replace(digit, end - digit, pieces[below(8)]);
        break;
      }
      default:
        text.insert(at, pieces[below(pieces.size())]);
    }
  }
  return text;
}

class Mutations : public ::testing::TestWithParam<std::string> {};

TEST_P(Mutations, EndWithAResultOrOneClearLine) {
  const Format& format = format_called(GetParam());
  std::mt19937_64 random(20261125);
  const std::vector<std::string> examples = format.examples();
#if defined(__SANITIZE_ADDRESS__)
  constexpr int kMutations = 100;
#else
  constexpr int kMutations = 500;
#endif
  const TemporaryFolder folder;
  int refused = 0, complaints = 0;
  for (int i = 0; i < kMutations && complaints < 5; ++i) {
    const std::string bytes = damaged(examples[static_cast<std::size_t>(i) % examples.size()], random);
    for (const Words& words : format.commands(bytes, folder)) {
      fs::remove_all(folder / "out");
      const ProcessResult result = bench_in_process(words);
      refused += result.exit_code >= 2 ? 1 : 0;
      const std::string complaint = complaint_about(result, folder, bytes, format.binary);
      if (complaint.empty()) continue;
      ++complaints;
      ADD_FAILURE() << complaint << "\n"
                    << ::testing::PrintToString(words) << "\n"
                    << result.err.substr(0, 500) << "\n--- input " << i << "\n"
                    << bytes.substr(0, 3000);
    }
  }
  EXPECT_GT(refused, kMutations / 10);
}

TEST_P(Mutations, ExamplesAreFine) {
  const Format& format = format_called(GetParam());
  const TemporaryFolder folder;
  for (const std::string& example : format.examples())
    for (const Words& words : format.commands(example, folder)) {
      const ProcessResult result = bench_in_process(words);
      EXPECT_EQ(result.exit_code, 0) << ::testing::PrintToString(words) << result.err;
      EXPECT_EQ(complaint_about(result, folder, example, format.binary), "") << result.out;
    }
}

// What fuzzing found worth keeping: tests/fuzz/corpus/FORMAT/*.
TEST_P(Mutations, TheCorpusEndsWithAResultOrOneClearLine) {
  const Format& format = format_called(GetParam());
  const fs::path corpus = source_dir() / "tests/fuzz/corpus" / format.name;
  if (!fs::exists(corpus)) return;
  const TemporaryFolder folder;
  for (const std::string& name : files_below(corpus))
    for (const Words& words : format.commands(content(corpus / name), folder)) {
      fs::remove_all(folder / "out");
      const ProcessResult result = bench_in_process(words);
      EXPECT_EQ(complaint_about(result, folder, content(corpus / name)), "") << name << "\n" << result.err;
    }
}

INSTANTIATE_TEST_SUITE_P(Every, Mutations, ::testing::ValuesIn(format_names()),
                         [](const auto& parameter) { return parameter.param; });

}  // namespace
}  // namespace odobench::testing
