// What reader and writer of set.json agree on.
#pragma once

namespace odobench {

inline constexpr const char* kDatasetSchema = "odobench-dataset";
inline constexpr int kDatasetSchemaVersion = 1;

}  // namespace odobench
