#include "reports/page/html_text.hpp"

#include <fmt/format.h>

#include "base/text.hpp"

namespace odobench {
namespace {

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
}

// Bytes of the code point that begins with this one.
std::size_t sequence_length(char first) {
  const auto byte = static_cast<unsigned char>(first);
  return byte < 0x80 ? 1 : byte < 0xE0 ? 2 : byte < 0xF0 ? 3 : 4;
}

}  // namespace

std::string html_escape(std::string_view given) {
  const std::string text = printable(given);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string html_symbol(std::string_view name) {
  const std::size_t underscore = name.find('_');
  const bool index = underscore != std::string_view::npos && underscore > 0 && underscore + 1 < name.size() &&
                     sequence_length(name[0]) == underscore && name.find(' ') == std::string_view::npos;
  if (!index) return html_escape(name);
  return fmt::format("<i>{}</i><sub>{}</sub>", html_escape(name.substr(0, underscore)),
                     html_escape(name.substr(underscore + 1)));
}

std::string html_json(const nlohmann::json& json) {
  std::string text = safe_json(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  replace_all(text, "<", "\\u003c");
  return text;
}

std::string html_script(std::string_view program) {
  std::string text(program);
  replace_all(text, "</script", "<\\/script");
  replace_all(text, "</SCRIPT", "<\\/SCRIPT");
  replace_all(text, "<!--", "<\\!--");
  return text;
}

std::string exact_text(double value) {
  return fmt::format("{}", value);
}

}  // namespace odobench
