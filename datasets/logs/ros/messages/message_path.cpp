#include "datasets/logs/ros/messages/message_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "base/text.hpp"

namespace odobench {
namespace {

constexpr std::size_t kLongestPathOfField = 1000, kMostPathSteps = 64;

[[noreturn]] void fail_path(std::string_view path, const char* expected) {
  throw std::invalid_argument(fmt::format("field '{}': expected {}", shown(path), expected));
}

// Where a selector begins behind a comma: "key=", with a key of letters, digits, '_', '/' and '.'.
bool begins_selector(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0) return false;
  return std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(equals), [](char c) {
    return c == '_' || c == '.' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  });
}

// The bracket that closes: one that a '.', another bracket or nothing follows, so that names may have some.
std::size_t closing_bracket(std::string_view text) {
  for (std::size_t at = text.find(']'); at != std::string_view::npos; at = text.find(']', at + 1))
    if (at + 1 == text.size() || text[at + 1] == '.') return at;
  return std::string_view::npos;
}

void take_brackets(PathStep& step, std::string_view inside, std::string_view path) {
  const char* end = inside.data() + inside.size();
  std::uint64_t index = 0;
  const auto [stop, error] = std::from_chars(inside.data(), end, index);
  if (error == std::errc{} && stop == end && !inside.empty()) {
    step.index = index;
    return;
  }
  while (!inside.empty()) {
    if (!begins_selector(inside)) fail_path(path, "[number] or [name=value]");
    std::size_t comma = inside.find(',');
    while (comma != std::string_view::npos && !begins_selector(inside.substr(comma + 1)))
      comma = inside.find(',', comma + 1);
    const std::string_view one = inside.substr(0, comma);
    const auto equals = one.find('=');
    step.selectors.push_back({std::string(one.substr(0, equals)), std::string(one.substr(equals + 1))});
    inside = comma == std::string_view::npos ? std::string_view{} : inside.substr(comma + 1);
  }
  if (step.selectors.empty()) fail_path(path, "[number] or [name=value]");
}

}  // namespace

std::vector<PathStep> parse_message_path(std::string_view path) {
  if (path.size() > kLongestPathOfField) fail_path(path, "a shorter path");
  std::vector<PathStep> steps;
  std::string_view rest = path;
  for (;;) {
    PathStep step;
    step.name = rest.substr(0, rest.find_first_of(".["));
    if (step.name.empty()) fail_path(path, "names with '.' between them");
    rest.remove_prefix(step.name.size());
    if (!rest.empty() && rest[0] == '[') {
      const std::size_t close = closing_bracket(rest);
      if (close == std::string_view::npos) fail_path(path, "a ']'");
      take_brackets(step, rest.substr(1, close - 1), path);
      rest.remove_prefix(close + 1);
    }
    steps.push_back(std::move(step));
    if (rest.empty()) return steps;
    if (steps.size() >= kMostPathSteps) fail_path(path, "fewer names");
    rest.remove_prefix(1);  // the '.'
  }
}

std::string path_step_text(const PathStep& step) {
  if (step.index) return fmt::format("{}[{}]", step.name, *step.index);
  if (step.selectors.empty()) return step.name;
  std::string inside;
  for (const PathStep::Selector& s : step.selectors)
    inside += fmt::format("{}{}={}", inside.empty() ? "" : ",", s.key, s.value);
  return fmt::format("{}[{}]", step.name, inside);
}

}  // namespace odobench
