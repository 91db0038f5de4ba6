// What every reader must give of small_log() (tests/support/log_writers.hpp).
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "datasets/logs/log_file.hpp"
#include "tests/support/log_writers.hpp"

namespace odobench::testing {

inline LogRequest log_request(const std::string& source, const std::vector<std::string>& fields) {
  LogRequest request;
  request.source = source;
  request.fields = fields;
  return request;
}

inline std::vector<LogRequest> small_log_requests() {
  return {
      log_request("/ticks", {"left", "right"}),
      log_request("/joints", {"position[name=left]", "position[name=right]", "velocity[name=left]"}),
      log_request("/tf", {"transforms[header.frame_id=odom,child_frame_id=base].transform.translation.x"})};
}

// Rows from message `begin` to before message `end`.
inline void expect_small_log(const std::vector<LogTable>& tables, int begin = 0,
                             int end = kSmallLogMessages) {
  ASSERT_EQ(tables.size(), 3u);
  std::size_t joints = 0;
  ASSERT_EQ(tables[0].time_ns.size(), static_cast<std::size_t>(end - begin));
  ASSERT_EQ(tables[2].time_ns.size(), tables[0].time_ns.size());
  for (int k = begin; k < end; ++k) {
    const auto row = static_cast<std::size_t>(k - begin);
    const std::int64_t stamp = kSmallLogBegin + k * kSmallLogStep;
    EXPECT_EQ(tables[0].time_ns[row], stamp);
    EXPECT_EQ(tables[0].log_time_ns[row], stamp + kSmallLogDelay);
    EXPECT_EQ(tables[0].values[0][row], k);
    EXPECT_EQ(tables[0].values[1][row], -2 * k);
    EXPECT_EQ(tables[2].time_ns[row], stamp);
    EXPECT_EQ(tables[2].values[0][row], k / 8.0);
    if (k % 3 == 2) continue;  // of the arm alone
    ASSERT_LT(joints, tables[1].time_ns.size());
    EXPECT_EQ(tables[1].time_ns[joints], stamp);
    EXPECT_EQ(tables[1].values[0][joints], k / 2.0);
    EXPECT_EQ(tables[1].values[1][joints], k / 4.0);
    EXPECT_EQ(tables[1].values[2][joints], 1);
    ++joints;
  }
  EXPECT_EQ(tables[1].time_ns.size(), joints);
}

inline void expect_small_log(const LogFile& log) {
  expect_small_log(log.read(small_log_requests(), {}));
}

}  // namespace odobench::testing
