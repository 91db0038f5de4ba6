#include "base/json_line.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace odobench {
namespace {

struct OpenPart {
  bool is_array = false;
  std::size_t index = 0;
  std::string_view key;
  std::size_t key_at = 0;
};

std::string path_of(const std::vector<OpenPart>& open) {
  std::string path;
  for (const OpenPart& level : open)
    path += "/" + (level.is_array ? std::to_string(level.index) : std::string(level.key));
  return path;
}

// Where the text that begins at `quote` ends.
std::size_t end_of_text(std::string_view text, std::size_t quote) {
  std::size_t end = quote + 1;
  while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
  return std::min(end, text.size());
}

}  // namespace

std::size_t json_line(std::string_view text, std::string_view path) {
  std::vector<OpenPart> open;
  bool key_next = false;
  const auto line = [text](std::size_t at) {
    return 1 + static_cast<std::size_t>(
                   std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
  };
  for (std::size_t i = 0; i < text.size() && !path.empty(); ++i) {
    const char c = text[i];
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ':') continue;
    if (c == ',') {
      if (open.back().is_array) ++open.back().index;
      key_next = !open.back().is_array;
      continue;
    }
    if (c == '}' || c == ']') {
      open.pop_back();
      key_next = false;
      continue;
    }
    if (key_next) {
      const std::size_t end = end_of_text(text, i);
      open.back().key = text.substr(i + 1, end - i - 1);
      open.back().key_at = i;
      key_next = false;
      i = end;
      continue;
    }
    // A value begins.
    if (!open.empty() && path_of(open) == path) return line(open.back().is_array ? i : open.back().key_at);
    if (c == '{' || c == '[') {
      open.push_back({c == '[', 0, {}, 0});
      key_next = c == '{';
    } else if (c == '"') {
      i = end_of_text(text, i);
    } else {  // a number or a word
      while (i + 1 < text.size() &&
             std::string_view(",]} \t\r\n").find(text[i + 1]) == std::string_view::npos)
        ++i;
    }
  }
  return 1;
}

}  // namespace odobench
