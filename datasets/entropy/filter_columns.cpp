#include "datasets/entropy/filter_columns.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/names.hpp"

namespace odobench {

std::optional<std::size_t> ColumnFinder::find(const std::string& name) const {
  const auto mapped = mapping_.find(name);
  const std::string& wanted = mapped == mapping_.end() ? name : mapped->second;
  if (wanted == kNoColumn) return std::nullopt;
  const std::vector<std::string>& names = row_.names();
  if (std::find(names.begin(), names.end(), wanted) != names.end()) return row_.column(wanted);
  if (mapped != mapping_.end()) missing(wanted, name);
  return std::nullopt;
}

std::optional<std::size_t> ColumnFinder::find_any(const std::vector<std::string>& names) const {
  for (const std::string& name : names)
    if (const auto column = find(name)) return column;
  return std::nullopt;
}

std::size_t ColumnFinder::require(const std::string& name) const {
  return require_any({name});
}

std::size_t ColumnFinder::require_any(const std::vector<std::string>& names) const {
  if (const auto column = find_any(names)) return *column;
  missing(names.front(), "");
}

void ColumnFinder::missing(const std::string& name, const std::string& purpose) const {
  std::vector<std::string> others;
  for (const std::string& column : row_.names())
    if (!column.empty() && std::find(known_.begin(), known_.end(), column) == known_.end())
      others.push_back(column);
  const std::string near = nearest_name(name, others);
  throw DataError(fmt::format(
      "{}:{}: found no column \"{}\"{}{}, expected it among the {} of the header{}", row_.file(),
      row_.header_line(), name, purpose.empty() ? "" : fmt::format(" (for {})", purpose),
      near.empty() ? "" : fmt::format("; the nearest is \"{}\"", near), row_.names().size(), row_.reading()));
}

}  // namespace odobench
