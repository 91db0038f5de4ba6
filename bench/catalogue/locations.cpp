#include "bench/catalogue/locations.hpp"

#include <fmt/format.h>

#include <system_error>

#include "base/error.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> roots() {
  std::vector<fs::path> list;
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (!error) list.push_back(executable.parent_path().parent_path() / "share" / "odobench");
  list.push_back(fs::path(ODOBENCH_SOURCE_DIR) / "datasets");
  return list;
}

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

}  // namespace

fs::path demo_set() {
  std::string looked;
  for (const fs::path& root : roots()) {
    const fs::path path = root / "demo" / "set.json";
    if (is_there(path)) return path;
    looked += (looked.empty() ? "" : ", ") + path.string();
  }
  throw DataError(fmt::format(
      "the demo data set is at none of {}; give --data=set.json or make it with 'bench demo --out=DIR'",
      looked));
}

fs::path scenario_folder() {
  for (const fs::path& root : roots())
    if (is_there(root / "scenarios")) return root / "scenarios";
  return {};
}

std::vector<std::pair<std::string, fs::path>> known_sets() {
  std::vector<std::pair<std::string, fs::path>> list;
  for (const fs::path& root : roots()) {
    const fs::path demo = root / "demo" / "set.json";
    if (list.empty() && is_there(demo)) list.emplace_back("demo", demo);
  }
  for (const fs::path& fetched : {fs::path("data") / "vitko2024" / "set.json",
                                  fs::path(ODOBENCH_SOURCE_DIR) / "data" / "vitko2024" / "set.json"})
    if (is_there(fetched)) {
      list.emplace_back("vitko2024", fetched);
      break;
    }
  return list;
}

}  // namespace odobench
