// Every row of the list of kinds (reports/kinds/kinds.hpp), over one record of every verb.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "base/json_node.hpp"
#include "reports/kinds/kinds.hpp"
#include "reports/page/report_document.hpp"
#include "reports/render/table.hpp"
#include "tests/support/data/report_records.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;

std::vector<RunRecord> records_of_every_verb() {
  std::vector<RunRecord> records =
      read_records((source_dir() / "tests/reports/records_schema_1.jsonl").string());
  // Kinds that came later.
  RunRecord model = testing::run_record("robot_1", 0);
  model.problem = "models";
  model.kind = "evaluation";
  model.measures = {{"total", 0.38, "m + rad", Better::Lower},
                    {"held_total", 0.39, "m + rad", Better::Lower}};
  model.notes = {"reading: fits"};
  records.push_back(std::move(model));
  return records;
}

std::string tables_of(const std::vector<RunRecord>& records) {
  return render_json(record_tables(records, {}, true));
}

TEST(RecordKinds, HaveNamesOfTheirOwnAndOneTakesTheRest) {
  std::set<std::string> names;
  int rest = 0;
  for (const RecordKind& kind : record_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_STRNE(kind.about, "") << kind.name;
    if (kind.wants == nullptr) ++rest;
  }
  EXPECT_EQ(rest, 1);
  for (const RecordKind& kind : record_kinds()) {
    if (kind.shown_with == nullptr) {
      EXPECT_NE(kind.tables, nullptr) << kind.name;
      EXPECT_NE(kind.page, nullptr) << kind.name;
      continue;
    }
    EXPECT_EQ(names.count(kind.shown_with), 1u) << kind.name;
    EXPECT_STRNE(kind.shown_with, kind.name);
  }
}

TEST(RecordKinds, NoProblemIsWantedTwice) {
  for (const RunRecord& record : records_of_every_verb()) {
    int wanted = 0;
    for (const RecordKind& kind : record_kinds())
      if (kind.wants != nullptr && kind.wants(record.problem)) ++wanted;
    EXPECT_LE(wanted, 1) << record.problem;
  }
}

TEST(RecordKinds, RecordsOfEveryRowComeBackAsTheSameTables) {
  for (const RecordKind& kind : record_kinds()) {
    std::vector<RunRecord> records, again;
    for (const RunRecord& record : records_of_every_verb()) {
      if (&kind_of(record.problem) != &kind) continue;
      records.push_back(record);
      again.push_back(record_from(JsonNode::parse(to_json_line(record), "record")));
    }
    ASSERT_FALSE(records.empty()) << "no example of a record of kind " << kind.name;
    EXPECT_FALSE(record_tables(records, {}, true).empty()) << kind.name;
    EXPECT_EQ(tables_of(again), tables_of(records)) << kind.name;
  }
}

TEST(RecordKinds, PagesHaveASectionOfEveryKind) {
  for (const RecordKind& kind : record_kinds()) {
    ReportInput input;
    for (const RunRecord& record : records_of_every_verb())
      if (&kind_of(record.problem) == &kind) input.records.push_back(record);
    const Document document = make_report(input);
    std::size_t blocks = 0;
    for (const Section& section : document.sections)
      if (section.id != "summary" && section.id != "provenance") blocks += section.blocks.size();
    EXPECT_GT(blocks, 0u) << kind.name;
  }
}

TEST(RecordKinds, RecordsOfAnotherVersionsKindAreSaid) {
  RunRecord record = testing::run_record("robot_1", 0);
  record.problem = "localisation";
  record.kind = "evaluation";
  record.cost.reset();
  record.measures.put({"drift", 0.1, "m"});
  EXPECT_TRUE(record_tables({record}, {}, false).empty());
  ASSERT_EQ(unknown_records({record, record}).size(), 1u);
  EXPECT_THAT(unknown_records({record, record})[0], HasSubstr("2 records of 'localisation' are of no kind"));
  EXPECT_THAT(unknown_records({record})[0], HasSubstr("1 record of 'localisation' is of no kind"));
  record.cost = 1;
  EXPECT_TRUE(unknown_records({record}).empty());
  EXPECT_TRUE(unknown_records(records_of_every_verb()).empty());
}

}  // namespace
}  // namespace odobench
