#include "reports/render/text_width.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/text.hpp"

namespace odobench {
namespace {

struct Range {
  char32_t first, last;
};
constexpr std::array<Range, 6> kCombining{{{0x0300, 0x036F},
                                           {0x1AB0, 0x1AFF},
                                           {0x1DC0, 0x1DFF},
                                           {0x200B, 0x200F},
                                           {0x20D0, 0x20FF},
                                           {0xFE00, 0xFE2F}}};
constexpr std::array<Range, 7> kWide{{{0x1100, 0x115F},
                                      {0x2E80, 0xA4CF},
                                      {0xAC00, 0xD7A3},
                                      {0xF900, 0xFAFF},
                                      {0xFF00, 0xFF60},
                                      {0x1F300, 0x1FAFF},
                                      {0x20000, 0x3FFFD}}};

template <std::size_t N>
bool among(const std::array<Range, N>& ranges, char32_t c) {
  return std::any_of(ranges.begin(), ranges.end(),
                     [c](const Range& r) { return c >= r.first && c <= r.last; });
}

int width_of(char32_t c) {
  return among(kCombining, c) ? 0 : among(kWide, c) ? 2 : 1;
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(' ') - first + 1));
}

// Bytes of `text` that fit into `width` cells, at least one code point.
std::size_t fitting(std::string_view text, int width) {
  std::size_t at = 0;
  int used = 0;
  while (at < text.size()) {
    const CodePoint c = code_point_at(text, at);
    used += width_of(c.value);
    if (used > width && at > 0) break;
    at += c.bytes;
  }
  return at;
}

void wrap_line(std::string_view line, int width, std::vector<std::string>& out) {
  for (;;) {
    while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
    const std::size_t fits = fitting(line, width);
    if (fits == line.size()) break;
    std::size_t cut = fits;
    if (line[fits] != ' ') {
      if (const auto space = line.rfind(' ', fits - 1); space != std::string_view::npos && space > 0)
        cut = space;
      else if (const auto comma = line.rfind(',', fits - 1); comma != std::string_view::npos)
        cut = comma + 1;
    }
    out.push_back(trimmed(line.substr(0, cut)));
    line.remove_prefix(cut);
  }
  out.push_back(trimmed(line));
}

}  // namespace

int display_width(std::string_view text) {
  int width = 0;
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint c = code_point_at(text, at);
    width += width_of(c.value);
    at += c.bytes;
  }
  return width;
}

std::vector<std::string> wrap_text(std::string_view text, int width) {
  std::vector<std::string> lines;
  for (;;) {
    const auto end = text.find('\n');
    wrap_line(text.substr(0, end), std::max(width, 2), lines);
    if (end == std::string_view::npos) return lines;
    text.remove_prefix(end + 1);
  }
}

std::string pad_left(const std::string& text, int width) {
  return std::string(static_cast<std::size_t>(std::max(0, width - display_width(text))), ' ') + text;
}
std::string pad_right(const std::string& text, int width) {
  return text + std::string(static_cast<std::size_t>(std::max(0, width - display_width(text))), ' ');
}

}  // namespace odobench
