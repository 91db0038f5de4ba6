// Results of short runs, made once per test program.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench::testing {

inline std::vector<std::string> with(std::vector<std::string> words, const std::string& word) {
  words.push_back(word);
  return words;
}

inline std::string demo_file(const std::string& name) {
  return (source_dir() / "datasets/demo" / name).string();
}

// A run directory of lm on the demo set.
inline const std::string& run_folder() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    const std::string out = (folder / "run").string();
    EXPECT_EQ(
        run_bench({"--solver=lm", "--data=" + demo_file("set.json"), "--out=" + out, "--quiet"}).exit_code,
        0);
    return out;
  }();
  return path;
}

// Sensor logs of a simulated robot.
inline const std::string& filter_folder() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    const std::string out = (folder / "drive").string();
    EXPECT_EQ(run_bench({"simulate", "--scenario=filter_run", "--out=" + out}).exit_code, 0);
    return out;
  }();
  return path;
}

}  // namespace odobench::testing
