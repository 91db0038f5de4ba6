// Which vector instructions evaluate costs: asked for, named, refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/records/record.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using testing::bench_words;
using testing::expect_refusal;
using ::testing::HasSubstr;
using testing::Process;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

// The kernel that the records of a short run name; `variable`: the value of ODOBENCH_KERNEL, "" for none.
std::string kernel_of(const std::string& variable, const std::vector<std::string>& options) {
  const TemporaryFolder folder;
  std::vector<std::string> words{"/usr/bin/env"};
  if (!variable.empty()) words.push_back("ODOBENCH_KERNEL=" + variable);
  for (const std::string& word : bench_words({"--solver=lm", "--quiet", "--out=" + (folder / "o").string()}))
    words.push_back(word);
  words.insert(words.end(), options.begin(), options.end());
  const ProcessResult result = Process(words).wait();
  if (result.exit_code != 0) return result.err;
  std::string kernel;
  for (const RunRecord& r : read_records((folder / "o/runs.jsonl").string())) {
    EXPECT_TRUE(kernel.empty() || kernel == r.context.kernel);
    kernel = r.context.kernel;
  }
  return kernel;
}

TEST(CliKernel, IsChosenByTheOptionThenTheVariableThenTheProcessor) {
  EXPECT_EQ(kernel_of("", {"--kernel=baseline"}), "baseline");
  EXPECT_EQ(kernel_of("baseline", {}), "baseline");
  const std::string widest = kernel_of("", {});
  EXPECT_THAT(widest, ::testing::AnyOf("avx512", "avx2", "baseline"));
  EXPECT_EQ(kernel_of("baseline", {"--kernel=auto"}), widest);
  EXPECT_EQ(kernel_of("auto", {}), widest);
}

TEST(CliKernel, UnknownOnesAreRefused) {
  expect_refusal({"--solver=lm", "--kernel=avx1024"}, 2, {"--kernel=avx1024", "avx2"});
  EXPECT_THAT(kernel_of("avx1024", {}), HasSubstr("ODOBENCH_KERNEL=avx1024"));
}

TEST(CliKernel, ComparisonsNameKernelsThatDiffer) {
  const TemporaryFolder folder;
  const std::string a = (folder / "a").string(), b = (folder / "b").string();
  ASSERT_EQ(run_bench({"--solver=lm", "--quiet", "--out=" + a}).exit_code, 0);
  ASSERT_EQ(run_bench({"--solver=lm", "--quiet", "--kernel=baseline", "--out=" + b}).exit_code, 0);
  const std::string widest = read_records(a + "/runs.jsonl").front().context.kernel;
  const ProcessResult result = run_bench({"compare", a, b});
  if (widest != "baseline") {
    EXPECT_THAT(result.out, HasSubstr("kernel baseline, was " + widest));
  }
}

}  // namespace
}  // namespace odobench
