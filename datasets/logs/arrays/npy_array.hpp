// One array as .npy writes it.
#pragma once

#include <string>

#include "datasets/logs/arrays/array_log.hpp"
#include "datasets/logs/arrays/byte_source.hpp"

namespace odobench {

// Largest array, decompressed.
inline constexpr std::uint64_t kLargestArray = std::uint64_t{512} << 20;

// Reads header and numbers and gives them to the visitor under this name; what is not wanted or cannot be
// read is left. `place`: "FILE: MEMBER", for messages. DataError where it is damaged. True: all bytes were
// read.
bool walk_npy(ByteSource& bytes, const std::string& name, const std::string& place, ArrayVisitor& visitor,
              const Stop& stop);

}  // namespace odobench
