// What reader and writer of set.json agree on.
#pragma once

namespace odobench {

inline constexpr const char* kDatasetSchema = "odobench-dataset";
// 1: the thesis' robot, every sample with a reference. 2: any robot, signals by name, a reference where there
// is one.
inline constexpr int kDatasetSchemaVersion = 2;

}  // namespace odobench
