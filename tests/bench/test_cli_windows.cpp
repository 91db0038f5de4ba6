// `bench windows` as users see it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "reports/records/record.hpp"
#include "tests/support/data/entropy_windows.hpp"
#include "tests/support/data/small_dataset.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/measures.hpp"
#include "tests/support/refusal.hpp"

namespace odobench {
namespace {

using nlohmann::json;
using testing::content;
using testing::everything_in;
using testing::expect_refusal;
using ::testing::HasSubstr;
using testing::kData;
using testing::kUsage;
using testing::lines;
using testing::ProcessResult;
using testing::replaced;
using testing::run_bench;
using testing::TemporaryFolder;

json tables(std::vector<std::string> words) {
  words.insert(words.begin(), "windows");
  words.push_back("--format=json");
  const ProcessResult result = run_bench(words, 300);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return json::parse(result.out).at("tables");
}

TEST(CliWindows, InvariantOnEveryWindow) {
  const TemporaryFolder folder;
  const json all = tables({folder.file("w.json", testing::windows_json())});
  ASSERT_EQ(all.size(), 2u);
  const json& rows = all[0].at("rows");
  ASSERT_EQ(rows.size(), 6u * 3);
  for (std::size_t i = 0; i < rows.size(); i += 3) {
    const auto h = [&](std::size_t k) { return rows[i + k].at("hamiltonian").get<double>(); };
    EXPECT_EQ(rows[i].at("method"), "coordinate");
    EXPECT_LE(h(0), h(1) + 1e-12 * std::abs(h(1)));
    EXPECT_LE(h(1), h(2) + 1e-12 * std::abs(h(2)));
    EXPECT_LE(h(2), 0);
    EXPECT_EQ(rows[i].at("window"), rows[i + 2].at("window"));
    EXPECT_EQ(rows[i].at("samples"), 4 + static_cast<int>(i) / 3);
    std::istringstream t(rows[i + 1].at("t").get<std::string>());
    int count = 0;
    for (std::string level; t >> level; ++count) EXPECT_THAT(level, ::testing::AnyOf("-1", "0", "1"));
    EXPECT_EQ(count, 3 * (4 + static_cast<int>(i) / 3) - 5);
  }
  const json& methods = all[1].at("rows");
  ASSERT_EQ(methods.size(), 3u);
  EXPECT_EQ(methods[1].at("at_optimum"), 100);
  EXPECT_NEAR(methods[1].at("gap_max").get<double>(), 0, 1e-8);
  EXPECT_NEAR(methods[2].at("gap_relaxed_max").get<double>(), 0, 1e-8);
  EXPECT_GE(methods[0].at("gap_max").get<double>(), methods[0].at("gap_mean").get<double>());
}

TEST(CliWindows, RecordsReportSeedsAndThreads) {
  const TemporaryFolder folder;
  const std::string file = folder.file("w.json", testing::windows_json()), out = (folder / "out").string();
  const std::vector<std::string> words = {file, "--solver=pso,exact", "--max-evals=300", "--repeat=2",
                                          "--only=long"};
  std::vector<std::string> recorded = words;
  recorded.push_back("--out=" + out);
  const json first = tables(recorded);
  EXPECT_EQ(first[1].at("rows")[0].at("runs"), 6);
  EXPECT_EQ(first[1].at("rows")[1].at("runs"), 3);  // exact: once
  const std::vector<RunRecord> list = read_records(out + "/runs.jsonl");
  ASSERT_EQ(list.size(), 9u);
  for (const RunRecord& r : list) {
    EXPECT_EQ(r.problem, "entropy");
    EXPECT_EQ(r.group, "long");
    EXPECT_EQ(r.dataset.rfind("w/random", 0), 0u) << r.dataset;
    testing::expect_as_in_schema_1(r);
    EXPECT_NEAR(*r.measures.value("hamiltonian"), -*r.cost, 1e-8 * std::abs(*r.cost));
  }
  // The same bits with another number of threads, and alone.
  std::vector<std::string> single = words;
  single.push_back("--threads=1");
  const json second = tables(single);
  for (std::size_t i = 0; i < second[0].at("rows").size(); ++i)
    EXPECT_EQ(second[0].at("rows")[i].at("t"), first[0].at("rows")[i].at("t"));
  const ProcessResult report = run_bench({"report", out, "--format=json"});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_EQ(json::parse(report.out).at("tables")[1].at("id"), "methods");
  expect_refusal({"windows", file, "--out=" + out}, kUsage, {"runs.jsonl already"});
}

TEST(CliWindows, Refuses) {
  const TemporaryFolder folder;
  const std::string text = testing::windows_json(), out = "--out=" + (folder / "out").string();
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& part) {
    expect_refusal({"windows", folder.file("w.json", replaced(text, from, to)), out}, kData,
                   {"w.json", part});
  };
  refused("\"sigma_e\":0.005", "\"sigma_e\":0", "/windows/0/params/sigma_e: found 0, expected a number > 0");
  refused("\"dt\":0.1", "\"dt\":-1", "/windows/0/params/dt: found -1");
  refused("\"dt\":0.1", "\"dt\":1e308",
          "/windows/0/params/dt: found 1e+308, expected a number of at most 1e+50");
  refused("\"dt\":0.1", "\"dt\":1e309", ":1: /windows/0 (");
  refused("\"dt\":0.1", "\"dt\":1e309", "/dt: found 1e309, expected a number within the range of a double");
  refused("\"sigma_e\":0.005", "\"sigma_e\":1e-200", "window 'random0' overflows");
  refused("\"ay\":[", "\"ay\":[1,", "/windows/0/ay: found 5 numbers, expected 4");
  refused("\"id\":\"random1\"", "\"id\":\"random0\"", "a second time");
  refused("\"format\"", "\"fromat\"", "no key \"format\"");
  const std::string good = folder.file("w.json", text);
  expect_refusal({"windows", good, out, "--only=random9"}, kUsage, {"--only=random9", "did you mean"});
  expect_refusal({"windows", good, out, "--solver=exactt"}, kUsage, {"did you mean 'exact'?"});
  expect_refusal({"windows", (folder / "none.json").string()}, kData, {"none.json"});
  expect_refusal({"windows"}, kUsage, {"file"});
  EXPECT_EQ(everything_in(folder.path()), std::vector<std::string>{"w.json"});
}

// The eight methods of the project side by side on the reference windows, and what must hold of each.
TEST(CliWindows, OneTableOfAllMethods) {
  ODOBENCH_NEEDS_SHARED();
  const json all = tables({testing::reference_windows_file().string(), "--max-evals=1500", "--threads=2",
                           "--solver=coordinate,exact,relaxed,lm,ip,ga,pso,nlopt:bobyqa"});
  const json expected = testing::expected_of_windows();
  std::map<std::string, json> methods;
  for (const auto& row : all[1].at("rows")) methods[row.at("method")] = row;
  ASSERT_EQ(methods.size(), 8u);
  const double windows = static_cast<double>(expected.size());
  int greedy_at_optimum = 0;
  for (const auto& w : expected) greedy_at_optimum += w.at("greedy").at("t") == w.at("exact").at("t") ? 1 : 0;
  for (const auto& [name, row] : methods) EXPECT_EQ(row.at("runs"), windows) << name;
  EXPECT_EQ(methods["exact"].at("at_optimum"), 100);
  EXPECT_NEAR(methods["coordinate"].at("at_optimum").get<double>(), 100 * greedy_at_optimum / windows, 1e-9);
  // Convex and smooth: the derivative methods reach the relaxation.
  for (const char* name : {"relaxed", "lm"})
    EXPECT_LT(methods[name].at("gap_relaxed_max").get<double>(), 1e-3) << name;
  for (const char* name : {"ga", "pso", "nlopt:bobyqa"})
    EXPECT_GE(methods[name].at("gap_mean").get<double>(), 0) << name;

  // Each window against the independent evaluation: t, iterations, H.
  std::map<std::string, json> by_id;
  for (const auto& w : expected) by_id[w.at("id")] = w;
  for (const auto& row : all[0].at("rows")) {
    const std::string method = row.at("method");
    if (method != "coordinate" && method != "exact") continue;
    const json& want = by_id.at(row.at("window")).at(method == "exact" ? "exact" : "greedy");
    std::string t;
    for (const auto& level : want.at("t")) t += (t.empty() ? "" : " ") + std::to_string(level.get<int>());
    EXPECT_EQ(row.at("t"), t) << row.at("window") << method;
    EXPECT_NEAR(row.at("hamiltonian").get<double>(), want.at("H").get<double>(),
                1e-9 * std::abs(want.at("H").get<double>()));
    for (const auto& [ours, theirs] :
         {std::pair("r1", "r1"), std::pair("ax12", "ax12"), std::pair("sy1", "sy1")})
      EXPECT_NEAR(row.at(ours).get<double>(), want.at(theirs).get<double>(),
                  1e-9 * std::abs(want.at(theirs).get<double>()) + 1e-12);
    if (method == "coordinate") {
      EXPECT_EQ(row.at("iterations"), want.at("iterations"));
    }
  }
}

}  // namespace
}  // namespace odobench
