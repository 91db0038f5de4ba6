// How a separated text is written: found by looking at its header, never asked for.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace odobench {

struct CsvDialect {
  char separator = ',';         // ',', ';', '\t', or ' ' for any number of blanks
  bool declared = false;        // by a line "sep=;" at its beginning (Excel)
  bool comment_header = false;  // the header is a comment: "# time,x"

  // "separated by ';'", "separated by tabs".
  std::string text() const;
};

// Without blanks and tabs around.
std::string_view without_blanks(std::string_view text);

// The separator that divides this header line most often outside quotes: ; or tab or comma, else blanks, else
// `usual`.
char find_separator(std::string_view header, char usual);

// "sep=;" or "sep=": true, and the separator where one is named.
bool separator_line(std::string_view line, char& separator);

// "# ..." or "% ...": what stands behind the mark.
bool comment_line(std::string_view line, std::string_view& content);

// Why this line cannot be read as a text of UTF-8 or Latin-1: UTF-16, bytes of zero, Macintosh line breaks.
// "found ..., expected ..."; "" where it can.
std::string encoding_fault(std::string_view line);

// A decimal number, with point or comma.
bool looks_like_number(std::string_view field);

// Splits a line without its break. Blanks around fields and the quotes around "a field" are taken away
// (blanks inside quotes stay); a field with doubled quotes inside is written to `unescaped`. The views are
// into `line` or `unescaped`. False where a quote is not closed.
bool split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields,
                  std::deque<std::string>& unescaped);

}  // namespace odobench
