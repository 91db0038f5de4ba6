// Certified problems on the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/refusal.hpp"

namespace odobench {
namespace {

using testing::expect_refusal;
using ::testing::HasSubstr;
using testing::kUsage;
using testing::ProcessResult;
using testing::run_bench;

TEST(CliCertified, SolversRunOnThem) {
  const ProcessResult nist = run_bench({"--problem=nist:Misra1a/1", "--solver=lm"});
  EXPECT_EQ(nist.exit_code, 0) << nist.err;
  EXPECT_THAT(nist.out, HasSubstr("0.1245513889"));
  const ProcessResult mgh = run_bench({"--problem=mgh:penalty-1/10", "--solver=lm,ceres", "--dimension=4"});
  EXPECT_EQ(mgh.exit_code, 0) << mgh.err;
  EXPECT_THAT(mgh.out, HasSubstr("2.2499775"));
}

// The data lie in the program, not beside it.
TEST(CliCertified, TheListKnowsThem) {
  const ProcessResult list = run_bench({"list", "problems"});
  EXPECT_EQ(list.exit_code, 0) << list.err;
  for (const char* name : {"nist:Lanczos1/2", "nist:Thurber/1", "mgh:brown-dennis", "mgh:watson/100"})
    EXPECT_THAT(list.out, HasSubstr(name));
}

TEST(CliCertified, WrongNamesAndDimensionsAreRefused) {
  expect_refusal({"--problem=nist:Misra1a/1", "--dimension=3", "--solver=lm"}, kUsage,
                 {"nist:Misra1a/1", "dimension 3; expected 2"});
  expect_refusal({"--problem=nist:misra1a/1", "--solver=lm"}, kUsage, {"did you mean 'nist:Misra1a/1'?"});
  expect_refusal({"--problem=mgh:extended-rosenbrock", "--dimension=7", "--solver=lm"}, kUsage,
                 {"expected 2, 4, 6, ..."});
}

}  // namespace
}  // namespace odobench
