// Logs that are tables, for tests: opened as the program does, damaged in every way.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "base/json_node.hpp"
#include "datasets/logs/tables/table_logs.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench::testing {

// The log in this file, by the first format that recognises it; DataError where none does.
inline std::unique_ptr<LogFile> open_log(const std::filesystem::path& file, const LogOptions& options = {}) {
  std::ifstream in(file, std::ios::binary);
  std::string head(4096, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  for (const LogFormat& format : table_log_formats())
    if (format.recognises(file, head)) return format.open(file, options);
  throw DataError("no format");
}

inline LogRequest request(const std::string& source, const std::vector<std::string>& fields,
                          const std::string& time = "", const std::string& unit = "") {
  LogRequest wanted;
  wanted.source = source;
  wanted.fields = fields;
  wanted.time = time;
  wanted.time_unit = unit;
  return wanted;
}

inline LogTable read_log(const std::filesystem::path& file, const LogRequest& wanted,
                         const LogOptions& options = {}) {
  return open_log(file, options)->read({wanted}, Stop()).at(0);
}

inline double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::isnan(value) ? 0 : value;
  return sum;
}

// All that can be asked of a log, so that damaged ones meet every part of a reader.
inline void read_everything(const std::filesystem::path& file, const LogOptions& options = {}) {
  const std::unique_ptr<LogFile> log = open_log(file, options);
  for (const LogSource& source : log->sources(Stop())) {
    LogRequest wanted;
    wanted.source = source.name;
    for (const LogField& field : source.fields) wanted.fields.push_back(field.path);
    try {
      log->read({wanted}, Stop());
    } catch (const std::invalid_argument&) {  // no time in what is left
    }
  }
}

// Reads the file cut at every byte up to `dense` and at some behind it, and `flips` copies with random bytes
// changed: only DataError may come out.
inline void expect_robust(const std::string& bytes, const std::string& name, int flips,
                          std::size_t dense = 3000) {
  const TemporaryFolder folder;
  const auto attempt = [&](const std::string& damaged, const std::string& what) {
    const std::string file = folder.file(name, damaged);
    try {
      read_everything(file);
    } catch (const DataError& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << what;
    } catch (const std::invalid_argument& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << what;
    } catch (const std::exception& e) {
      ADD_FAILURE() << what << ": " << e.what();
    }
  };
  for (std::size_t end = 0; end < bytes.size(); end += end < dense ? 1 : 97)
    attempt(bytes.substr(0, end), "cut at " + std::to_string(end));
  std::mt19937 random(7);
  for (int k = 0; k < flips; ++k) {
    std::string damaged = bytes;
    for (unsigned count = 1 + random() % 4; count > 0; --count)
      damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    attempt(damaged, "flip " + std::to_string(k));
  }
}

// Most memory that this process has had so far [MB]; 0 with the address sanitizer, which keeps what is freed.
inline long peak_megabytes() {
#if defined(__SANITIZE_ADDRESS__)
  return 0;
#endif
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

inline std::filesystem::path log_samples() {
  return shared_folder() / "datasets" / "logs";
}

}  // namespace odobench::testing

#define ODOBENCH_NEEDS_LOGS()                                     \
  if (!std::filesystem::exists(odobench::testing::log_samples())) \
  GTEST_SKIP() << "needs " << odobench::testing::log_samples() << " (set ODOBENCH_SHARED)"
