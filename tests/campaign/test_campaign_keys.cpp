// What campaigns are made of: keys of records, lines of JSON, options of isolation and shards.
#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <string>

#include "base/json_line.hpp"
#include "bench/studies/campaign/campaign_plan.hpp"
#include "bench/studies/campaign/isolation.hpp"
#include "reports/records/record_key.hpp"

namespace odobench {
namespace {

TEST(JsonLine, OfMembersAndElements) {
  const std::string text =
      "{\n \"a\": [1,\n  {\"b\\\"]\": \"x,\\\"}\"},\n  3],\n\n \"c\": {\n  \"d\": -1e5}\n}\n";
  EXPECT_EQ(json_line(text, ""), 1u);
  EXPECT_EQ(json_line(text, "/a"), 2u);
  EXPECT_EQ(json_line(text, "/a/0"), 2u);
  EXPECT_EQ(json_line(text, "/a/1/b\\\"]"), 3u);
  EXPECT_EQ(json_line(text, "/a/2"), 4u);
  EXPECT_EQ(json_line(text, "/c"), 6u);
  EXPECT_EQ(json_line(text, "/c/d"), 7u);
}

TEST(RecordKey, SaysAllThatDecidesAResultAndNothingElse) {
  RunRecord r;
  r.problem = "p";
  r.solver = "pso";
  r.options = {{"swarm", "20"}};
  r.context.kernel = "avx2";
  const std::string key = record_key(r);
  const auto changed = [&](const auto& change) {
    RunRecord other = r;
    change(other);
    return record_key(other) != key;
  };
  EXPECT_TRUE(changed([](RunRecord& o) { o.problem = "q"; }));
  EXPECT_TRUE(changed([](RunRecord& o) { o.box = "b"; }));
  EXPECT_TRUE(changed([](RunRecord& o) { o.dataset_sha256 = "0"; }));
  EXPECT_TRUE(changed([](RunRecord& o) { o.options["swarm"] = "21"; }));
  EXPECT_TRUE(changed([](RunRecord& o) { o.polish = "lm"; }));
  EXPECT_TRUE(changed([](RunRecord& o) { o.seed = 2; }));
  EXPECT_TRUE(changed([](RunRecord& o) { o.budget["target"] = 1; }));
  EXPECT_TRUE(changed([](RunRecord& o) { o.context.version = "2"; }));
  EXPECT_TRUE(changed([](RunRecord& o) { o.context.kernel = "baseline"; }));
  EXPECT_TRUE(changed([](RunRecord& o) { o.context.git_revision = "a"; }));
  const auto later = [](RunRecord& o) {
    o.cost = 1;
    o.kind = "run";
    o.termination = "converged";
    o.seconds = 3;
    o.time_utc = "now";
    o.context.threads = 7;
    o.context.command = "bench";
    o.context.cpu = "another";
  };
  EXPECT_FALSE(changed(later));
  RunRecord one = r, two = r;
  one.trace = {{1, 0.5, 2}};
  two.trace = {{1, 0.25, 2}};
  later(two);
  two.cost = one.cost;
  two.kind = one.kind;
  two.termination = one.termination;
  EXPECT_EQ(result_check_sum(one), result_check_sum(two));
  two.trace[0].cost = 3;
  EXPECT_NE(result_check_sum(one), result_check_sum(two));
}

TEST(Isolation, Limits) {
  EXPECT_EQ(parse_isolation("--isolate", "").seconds, 0);
  EXPECT_EQ(parse_isolation("--isolate", "2.5").seconds, 2.5);
  const IsolationLimits both = parse_isolation("--isolate", "memory=2G,time=60");
  EXPECT_EQ(both.seconds, 60);
  EXPECT_EQ(both.memory, std::uint64_t{2} << 30);
  for (const char* bad : {"time=0", "memory=1K", "memory=", "cpu=1", "time=x", "memory=2T"})
    EXPECT_THROW(parse_isolation("--isolate", bad), std::invalid_argument) << bad;
}

// Pieces 0 and 2 take more than they may.
class Greedy final : public IsolatedWork {
 public:
  std::optional<std::string> run(std::size_t piece) override {
    const std::string memory(piece % 2 == 0 ? std::size_t{1} << 30 : 1, 'x');
    return memory.substr(0, 1);
  }
  void started(std::size_t) override {}
  void finished(std::size_t piece, const std::string& bytes) override {
    told += std::to_string(piece) + ":" + bytes + " ";
  }
  void failed(std::size_t piece, const std::string& reason) override {
    told += std::to_string(piece) + ":" + reason + " ";
  }
  void settled() override {}
  std::string told;
};

TEST(Isolation, TooMuchMemoryCostsThePieceOnly) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "address sanitizers need more address space than any limit";
#endif
  Greedy work;
  run_isolated(4, 1, {0, std::uint64_t{512} << 20}, {}, work);
  EXPECT_EQ(work.told, "0:no memory is left 1:x 2:no memory is left 3:x ");
}

TEST(Shards, Text) {
  EXPECT_EQ(parse_shard("--shard", "2/4").text(), "2/4");
  EXPECT_EQ(parse_shard("--shard", "1/1").text(), "");
  for (const char* bad : {"0/4", "5/4", "2", "/4", "2/", "a/b", "1/0"})
    EXPECT_THROW(parse_shard("--shard", bad), std::invalid_argument) << bad;
}

}  // namespace
}  // namespace odobench
