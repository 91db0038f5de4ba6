#include "bench/catalogue/option_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <thread>

namespace odobench {

std::vector<std::string> comma_items(const std::string& list) {
  std::vector<std::string> items;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    items.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return items;
}

std::vector<std::string> comma_items(const std::vector<std::string>& lists) {
  std::vector<std::string> all;
  for (const std::string& list : lists)
    for (std::string& item : comma_items(list)) all.push_back(std::move(item));
  return all;
}

Existing existing_files(bool overwrite) {
  return overwrite ? Existing::Replace : Existing::Refuse;
}

void refuse_existing(const char* option, const std::string& path, bool overwrite) {
  if (!path.empty() && path != "-") require_writable(path, existing_files(overwrite), option);
}

void refuse_existing_folder(const char* option, const std::string& path, bool overwrite) {
  std::error_code e;
  if (!overwrite && std::filesystem::exists(std::filesystem::symlink_status(path, e)))
    throw std::invalid_argument(
        fmt::format("{}={}: it exists; choose another name or give --overwrite", option, shown_path(path)));
}

int thread_count(int asked) {
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

InstructionSet kernel_in_force(std::optional<InstructionSet> asked) {
  if (asked) return *asked;
  const char* const variable = std::getenv("ODOBENCH_KERNEL");
  const std::string name = variable == nullptr ? "" : variable;
  return name.empty() ? widest_instruction_set() : instruction_set("ODOBENCH_KERNEL", name);
}

}  // namespace odobench
