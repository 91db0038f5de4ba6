// What a writer says of a measure against what the reader of schema 1 says of its name.
#pragma once

#include <gtest/gtest.h>

#include "reports/records/record.hpp"
#include "reports/records/schema_1.hpp"

namespace odobench::testing {

inline void expect_same_measure(const Measure& a, const Measure& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.value, b.value) << a.name;
  EXPECT_EQ(a.unit, b.unit) << a.name;
  EXPECT_EQ(a.better, b.better) << a.name;
  EXPECT_EQ(a.of, b.of) << a.name;
  EXPECT_EQ(a.timing, b.timing) << a.name;
}

// Records of either schema can be compared with each other only where both say the same.
inline void expect_as_in_schema_1(const RunRecord& record) {
  EXPECT_FALSE(record.measures.empty());
  for (const Measure& m : record.measures) expect_same_measure(m, schema_1_measure(m.name, m.value));
}

}  // namespace odobench::testing
