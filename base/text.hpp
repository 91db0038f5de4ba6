// Text of files and users on its way to a terminal, a message or a table: nothing in it may steer the
// reader's terminal or hide.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace odobench {

// One character of UTF-8. `value` is 0xFFFD and `bytes` 1 where `valid` is false: overlong forms, surrogates,
// lone and missing continuation bytes, and values beyond U+10FFFF are not UTF-8.
struct CodePoint {
  char32_t value = 0xFFFD;
  std::size_t bytes = 1;
  bool valid = false;
};
CodePoint code_point_at(std::string_view text, std::size_t at);

bool is_valid_utf8(std::string_view text);

// The text with all escaped that is not meant to be seen: control characters (C0, DEL, C1), line separators,
// characters that turn the direction of writing, zero-width and tag characters as \n, \t, \x1b, \u202e,
// \U000e0041, each byte that is not UTF-8 as \xff. Always valid UTF-8 on one line.
std::string printable(std::string_view text);

// printable() of what a message quotes, at most `most` characters (at least 8): of longer text the beginning
// and "...".
std::string shown(std::string_view text, std::size_t most = 80);

// One line of at most 2,000 characters: a message as it goes to standard error. Of longer ones the middle is
// left out.
std::string one_line_message(std::string_view text);

// JSON text as nlohmann::json writes it, with the characters that printable() escapes as \uXXXX: the same
// document, safe to look at. `text` must be valid JSON, where such characters stand inside strings only; line
// breaks and tabs between tokens stay.
std::string safe_json(std::string text);

}  // namespace odobench
