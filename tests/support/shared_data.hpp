// Where the tests find the real recordings and reference vectors, which are not part of the repository.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/source_dir.hpp"

namespace odobench::testing {

// $ODOBENCH_SHARED, or the folder shared/ beside the repository.
inline std::filesystem::path shared_folder() {
  if (const char* folder = std::getenv("ODOBENCH_SHARED")) return folder;
  return source_dir().parent_path() / "shared";
}
inline bool has_shared() {
  return std::filesystem::exists(shared_folder() / "reference");
}

}  // namespace odobench::testing

// First line of every test that needs them: the test is reported as skipped, by name, when they are absent.
#define ODOBENCH_NEEDS_SHARED()         \
  if (!odobench::testing::has_shared()) \
  GTEST_SKIP() << "needs " << odobench::testing::shared_folder() << " (set ODOBENCH_SHARED)"
