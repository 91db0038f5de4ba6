#include "tests/support/source_dir.hpp"

namespace odobench::testing {

std::filesystem::path source_dir() {
  return ODOBENCH_SOURCE_DIR;
}

}  // namespace odobench::testing
