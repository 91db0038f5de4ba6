// The binary recording file (docs/data_format.md): one line of JSON, padded with blanks to a multiple of 64
// bytes, that names the columns; then the columns one after the other, little-endian: time_us as int64, the
// others as float64.
#pragma once

#include <string>
#include <string_view>

#include "base/error.hpp"
#include "datasets/recording.hpp"

namespace odobench {

// The version of a file is the schema of its set: 1 has the columns of the thesis' robot, 2 those of the
// recording's signals, and not-a-number in x, y, theta at stamps without a reference.
std::string encode_recording(const Recording& recording, int schema);

// What set.json says about a recording file.
struct ExpectedRecording {
  std::string file;  // as it is to appear in messages
  std::size_t samples = 0;
  std::string sha256;
  int schema = 1;
};

// Fills the columns of recording, which has the names and kinds of its signals. Throws DataError "file: byte
// N: ..." about a broken header, another version, other columns, a size that is not the stated one, a wrong
// sum, and everything find_fault() finds.
void decode_recording(std::string_view bytes, const ExpectedRecording& expected, Recording& recording);

}  // namespace odobench
