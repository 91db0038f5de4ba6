// Series of records by name.
#pragma once

#include <cstddef>
#include <vector>

#include "reports/records/record.hpp"

namespace odobench {

// Null when the record has no series of this name and length.
inline const std::vector<double>* series_of(const RunRecord& record, const char* name, std::size_t size) {
  const auto found = record.series.find(name);
  return found == record.series.end() || found->second.size() != size ? nullptr : &found->second;
}

}  // namespace odobench
