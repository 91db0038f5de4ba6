#include "datasets/import/csv/csv_files.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <stdexcept>

#include "base/files.hpp"
#include "base/text.hpp"

namespace odobench::csv_import {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostDigits = 4;
constexpr std::size_t kMostFiles = 100'000;

bool by_name_and_number(const fs::path& a, const fs::path& b) {
  const NameParts p = name_parts(a), q = name_parts(b);
  if (p.trajectory != q.trajectory) return p.trajectory < q.trajectory;
  return p.number != q.number ? p.number < q.number : a < b;
}

// The files of a folder whose names fit the pattern.
std::vector<fs::path> fitting(const fs::path& folder, const std::string& pattern, const std::string& given) {
  std::vector<fs::path> files;
  std::error_code error, unreadable;
  const fs::path place = folder.empty() ? "." : folder;
  for (fs::directory_iterator at(place, error), end; !error && at != end; at.increment(error))
    if (::fnmatch(pattern.c_str(), at->path().filename().c_str(), FNM_PERIOD) == 0 &&
        !at->is_directory(unreadable))
      files.push_back(folder / at->path().filename());
  if (error)
    throw DataError(fmt::format("{}: found no folder that can be read ({}), expected one with CSV files",
                                shown_path(place), error.message()));
  if (files.empty())
    throw DataError(fmt::format("{}: found no file {} in {}, expected one at least", shown(given),
                                shown(pattern), shown_path(place)));
  if (files.size() > kMostFiles)
    throw DataError(
        fmt::format("{}: found {} files, expected at most {}", shown(given), files.size(), kMostFiles));
  std::sort(files.begin(), files.end(), by_name_and_number);
  return files;
}

}  // namespace

std::vector<fs::path> csv_files(const std::vector<std::string>& items) {
  std::vector<fs::path> files;
  std::set<fs::path> seen;
  for (const std::string& item : items) {
    if (item.empty())
      throw std::invalid_argument("found an empty name, expected a CSV file, folder or pattern");
    const fs::path path = item;
    std::error_code error;
    std::vector<fs::path> some = {path};
    if (fs::is_directory(path, error))
      some = fitting(path, "*.csv", item);
    else if (!fs::exists(path, error) && path.filename().string().find_first_of("*?") != std::string::npos)
      some = fitting(path.parent_path(), path.filename().string(), item);
    for (const fs::path& file : some) {
      if (!seen.insert(fs::absolute(file).lexically_normal()).second)
        throw std::invalid_argument(fmt::format("file {} is given twice", shown_path(file)));
      files.push_back(file);
    }
  }
  if (files.empty()) throw std::invalid_argument("no file to import, expected one at least");
  return files;
}

NameParts name_parts(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::size_t end = stem.find_last_not_of("0123456789");
  if (end == std::string::npos || end == 0 || (stem[end] != '_' && stem[end] != '-')) return {stem, 0};
  const std::size_t digits = stem.size() - end - 1;
  if (digits < 1 || digits > kMostDigits) return {stem, 0};
  int number = 0;
  std::from_chars(stem.data() + end + 1, stem.data() + stem.size(), number);
  return {stem.substr(0, end), number};
}

std::string as_id(const std::string& text) {
  std::string id;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '-' || c == '.';
    id += plain ? c : '_';
  }
  if (id.empty() || id.front() == '.') id.insert(0, 1, '_');
  return id;
}

}  // namespace odobench::csv_import
