// The binary recording file (docs/data_format.md): one line of JSON, padded with blanks to a multiple of 64
// bytes, that names the columns; then the columns one after the other, little-endian: time_us as int64, the
// others as float64.
#pragma once

#include <string>
#include <string_view>

#include "base/error.hpp"
#include "datasets/recording.hpp"

namespace odobench {

inline constexpr int kRecordingFormatVersion = 1;

// The columns must be equally long.
std::string encode_recording(const Recording& recording);

// What set.json says about a recording file.
struct ExpectedRecording {
  std::string file;  // as it is to appear in messages
  std::size_t samples = 0;
  std::string sha256;
};

// Fills the columns of recording. Throws DataError "file: byte N: ..." about a broken header, another
// version, other columns, a size that is not the stated one, a wrong sum, and everything find_fault() finds.
void decode_recording(std::string_view bytes, const ExpectedRecording& expected, Recording& recording);

}  // namespace odobench
