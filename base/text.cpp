#include "base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace odobench {
namespace {

struct Range {
  char32_t first, last;
};
// Zero-width joiners (U+200C, U+200D) are letters of Persian and Hindi and stay.
constexpr Range kHidden[] = {{0x00, 0x1F},     {0x7F, 0x9F},     {0xAD, 0xAD},     {0x61C, 0x61C},
                             {0x180E, 0x180E}, {0x200B, 0x200B}, {0x200E, 0x200F}, {0x2028, 0x202E},
                             {0x2060, 0x206F}, {0xFEFF, 0xFEFF}, {0xFFF0, 0xFFFB}, {0xE0000, 0xE0FFF}};

bool hidden(char32_t c) {
  return std::any_of(std::begin(kHidden), std::end(kHidden),
                     [c](const Range& r) { return c >= r.first && c <= r.last; });
}

std::string escape(char32_t value) {
  const auto number = static_cast<std::uint32_t>(value);
  if (value == '\n') return "\\n";
  if (value == '\r') return "\\r";
  if (value == '\t') return "\\t";
  if (value < 0x100) return fmt::format("\\x{:02x}", number);
  return value < 0x10000 ? fmt::format("\\u{:04x}", number) : fmt::format("\\U{:08x}", number);
}

// Appends the character at `at`, escaped where it has to be; how many bytes it took.
std::size_t append_printable(std::string_view text, std::size_t at, std::string& out) {
  const CodePoint c = code_point_at(text, at);
  if (!c.valid)
    out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at]));
  else if (hidden(c.value))
    out += escape(c.value);
  else
    out += text.substr(at, c.bytes);
  return c.bytes;
}

std::size_t characters(std::string_view valid) {
  return static_cast<std::size_t>(std::count_if(
      valid.begin(), valid.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

constexpr std::size_t kLongestMessage = 2000;

}  // namespace

CodePoint code_point_at(std::string_view text, std::size_t at) {
  const auto lead = static_cast<unsigned char>(text[at]);
  if (lead < 0x80) return {lead, 1, true};
  const std::size_t bytes = lead >= 0xF0 && lead < 0xF5   ? 4
                            : lead >= 0xE0 && lead < 0xF0 ? 3
                            : lead >= 0xC2 && lead < 0xE0 ? 2
                                                          : 0;
  if (bytes == 0 || at + bytes > text.size()) return {};
  char32_t value = lead & (0xFFu >> (bytes + 1));
  for (std::size_t k = 1; k < bytes; ++k) {
    const auto next = static_cast<unsigned char>(text[at + k]);
    if ((next & 0xC0) != 0x80) return {};
    value = (value << 6) | (next & 0x3Fu);
  }
  const char32_t least = bytes == 4 ? 0x10000 : bytes == 3 ? 0x800 : 0x80;
  if (value < least || value > 0x10FFFF || (value >= 0xD800 && value <= 0xDFFF)) return {};
  return {value, bytes, true};
}

bool is_valid_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint c = code_point_at(text, at);
    if (!c.valid) return false;
    at += c.bytes;
  }
  return true;
}

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) at += append_printable(text, at, out);
  return out;
}

std::string shown(std::string_view text, std::size_t most) {
  most = std::max<std::size_t>(most, 8);
  std::string out;
  std::size_t used = 0, kept = 0;  // characters; bytes of the beginning that leaves room for the dots
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t before = out.size();
    at += append_printable(text, at, out);
    used += characters(std::string_view(out).substr(before));
    if (used + 3 <= most) kept = out.size();
    if (used > most) return out.substr(0, kept) + "...";
  }
  return out;
}

std::string one_line_message(std::string_view text) {
  // Messages that were put together from several lines read on as one.
  std::string line(text.substr(0, 4 * kLongestMessage));
  std::string tail;
  if (text.size() > line.size()) tail = text.substr(std::max(line.size(), text.size() - kLongestMessage));
  for (std::string* part : {&line, &tail}) {
    std::replace(part->begin(), part->end(), '\n', ' ');
    *part = printable(*part);
  }
  if (tail.empty() && characters(line) <= kLongestMessage) return line;
  const std::string end = tail.empty() ? line : tail;
  std::size_t last = end.size() - std::min(end.size(), kLongestMessage / 4);
  while (last < end.size() && (static_cast<unsigned char>(end[last]) & 0xC0) == 0x80) ++last;
  return shown(line, 3 * kLongestMessage / 4 - 1) + " " + end.substr(last);
}

std::string safe_json(std::string text) {
  const auto plain = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x7F;  // controls of strings are escaped already
  };
  if (std::all_of(text.begin(), text.end(), plain)) return text;
  std::string out;
  out.reserve(text.size() + 16);
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint c = code_point_at(text, at);
    if (c.valid && c.value >= 0x7F && hidden(c.value)) {
      const auto number = static_cast<std::uint32_t>(c.value);
      if (number < 0x10000) {
        out += fmt::format("\\u{:04x}", number);
      } else {
        out += fmt::format("\\u{:04x}\\u{:04x}", 0xD800 + ((number - 0x10000) >> 10),
                           0xDC00 + ((number - 0x10000) & 0x3FF));
      }
    } else {
      out.append(text, at, c.bytes);
    }
    at += c.bytes;
  }
  return out;
}

}  // namespace odobench
