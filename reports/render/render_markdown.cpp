#include <fmt/format.h>

#include <cctype>

#include "reports/render/cell_text.hpp"
#include "reports/render/table.hpp"

namespace odobench {
namespace {

bool is_word(const std::string& text, std::size_t at) {
  return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) || (text[at] & 0x80) != 0);
}

// What GitHub would take for a cell border, emphasis, code, HTML, mathematics or a link. An underscore inside
// a word is none of these and stays readable.
std::string escaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n' || c == '\r') {
      out += ' ';
      continue;
    }
    const bool special = std::string("\\|`*<$~").find(c) != std::string::npos;
    const bool edge = c == '_' && !(i > 0 && is_word(text, i - 1) && is_word(text, i + 1));
    const bool link = c == ']' && i + 1 < text.size() && text[i + 1] == '(';
    const bool entity = c == '&' && is_word(text, i + 1);
    if (special || edge || link || entity) out += '\\';
    out += c;
  }
  return out;
}

std::string cell_markdown(const Cell& cell) {
  const CellText text = cell_text(cell);
  if (!cell.best) return escaped(whole_text(text));
  return fmt::format("**{}**{}{}", escaped(text.head), text.tail.empty() ? "" : " ", escaped(text.tail));
}

}  // namespace

std::string markdown_note(const std::string& note) {
  return fmt::format("- {}\n", escaped(note));
}

std::string render_markdown(const std::vector<Table>& tables) {
  std::string out;
  for (const Table& table : tables) {
    if (!out.empty()) out += "\n";
    out += fmt::format("### {}\n\n", escaped(table.title));
    if (!table.sentences.empty()) {
      for (const std::string& sentence : sentences_of(table)) out += markdown_note(sentence);
      for (const std::string& note : table.notes) out += markdown_note(note);
      continue;
    }
    out += "|";
    for (const Column& column : table.columns) out += fmt::format(" {} |", escaped(heading(column)));
    out += "\n|";
    for (const Column& column : table.columns) out += column.align == Align::Right ? " ---: |" : " :--- |";
    out += "\n";
    for (const auto& row : table.rows) {
      out += "|";
      for (const Cell& cell : row) out += fmt::format(" {} |", cell_markdown(cell));
      out += "\n";
    }
    if (!table.notes.empty()) out += "\n";
    for (const std::string& note : table.notes) out += markdown_note(note);
  }
  return out;
}

}  // namespace odobench
