// What a user sees when bench refuses: one line, the exit code, nothing on standard output.
#pragma once

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/support/run_process.hpp"

namespace odobench::testing {

inline constexpr int kUsage = 2;
inline constexpr int kData = 3;
inline constexpr int kInterrupted = 130;

// Fails unless bench ends with `code` and one line on standard error that holds every one of `parts`;
// standard output stays empty.
inline void expect_refusal(const std::vector<std::string>& words, int code,
                           const std::vector<std::string>& parts) {
  const ProcessResult result = run_bench(words);
  std::string command;
  for (const std::string& word : words) command += " " + word;
  SCOPED_TRACE(command);
  EXPECT_EQ(result.exit_code, code) << result.err;
  EXPECT_THAT(result.out, ::testing::IsEmpty());
  EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
  EXPECT_THAT(result.err, ::testing::StartsWith("bench: error: "));
  for (const std::string& part : parts) EXPECT_THAT(result.err, ::testing::HasSubstr(part));
}

}  // namespace odobench::testing
