// What reads MAT files of version 7.3: libmatio, which damaged files can crash or hang, so that it runs in a
// process of its own and says what it finds through a pipe.
#pragma once

#include <filesystem>

namespace odobench {

// What comes through the pipe: a byte of this, then
//   Array: name (u32 length, bytes), u8 class of MATLAB (6 to 15; + 128: logical), u32 rank, u64 dimensions,
//          u64 count of bytes, the numbers column by column
//   Skip, Fault: name, reason (each u32 length, bytes)
enum class Mat73Message : unsigned char { End = 0, Array = 1, Skip = 2, Fault = 3 };

// This program was built with libmatio.
bool has_matio();

// Reads the file and writes all of it to the pipe. To be called in the child only; does not return.
[[noreturn]] void read_mat73_in_child(const std::filesystem::path& file, int pipe);

}  // namespace odobench
