// Lines of a text file, read piece by piece: memory does not depend on the file's length.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace odobench {

class TextLines {
 public:
  // Longest line accepted [bytes]: what has no line break at all must not fill the memory.
  static constexpr std::size_t kLongestLine = 1 << 20;

  // Opens a regular file ("-" is standard input, which may be a pipe); DataError when it cannot be read. Once
  // `interrupt` (may be null) is set the text ends, also while a pipe delivers nothing.
  explicit TextLines(const std::filesystem::path& file, const std::atomic<bool>* interrupt = nullptr);
  ~TextLines();
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;

  // The next line without its break (LF or CRLF), valid until the next call; false at the end. DataError
  // "FILE:LINE: found a line longer than ..." and what reading throws.
  bool next(std::string_view& line);
  // A blank line was read: is the rest blank too? Passes over what it has looked at only where it is.
  bool only_blank_lines_left();

  const std::string& name() const { return name_; }  // of the file, for messages
  std::size_t line() const { return line_; }         // number of the line read last, from 1
  bool unfinished() const { return unfinished_; }    // the line read last had no break
  bool interrupted() const { return interrupted_; }  // `interrupt` ended the text

 private:
  bool fill();
  bool take(std::string_view& line, std::size_t length, std::size_t used);

  std::string name_;
  int descriptor_ = -1;
  const std::atomic<bool>* interrupt_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // what is read and not yet used
  std::size_t line_ = 0;
  bool at_end_ = false, interrupted_ = false, unfinished_ = false;
};

}  // namespace odobench
