#include <algorithm>
#include <limits>

#include "reports/render/cell_text.hpp"
#include "reports/render/table.hpp"
#include "reports/render/text_width.hpp"

namespace odobench {
namespace {

constexpr int kGutter = 2;  // cells between columns
constexpr const char* kStarNote = "*: best of its column.";
constexpr int kNarrowest = 24;  // text columns are wrapped down to this width before a table is split

// One column laid out: numbers stand under numbers and brackets under brackets.
struct ConsoleColumn {
  std::size_t column = 0;
  std::vector<CellText> cells;
  int head = 0, tail = 0;  // widths
  int width = 0;           // now
  int narrowest = 0;
  bool wraps = false;
};

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

ConsoleColumn lay_out(const Table& table, std::size_t column, bool bold) {
  const Column& spec = table.columns[column];
  ConsoleColumn out;
  out.column = column;
  out.wraps = spec.align == Align::Left;
  for (const auto& row : table.rows) {
    CellText text = cell_text(row[column]);
    text.head = one_line(text.head);
    text.tail = one_line(text.tail);
    if (row[column].best && !bold) text.tail += text.tail.empty() ? "*" : " *";
    if (row[column].value) out.wraps = false;
    out.head = std::max(out.head, display_width(text.head));
    out.tail = std::max(out.tail, display_width(text.tail));
    out.cells.push_back(std::move(text));
  }
  out.width = out.head + (out.tail > 0 ? 1 + out.tail : 0);
  out.width =
      std::max({out.width, display_width(spec.name), spec.unit.empty() ? 0 : display_width(spec.unit) + 2});
  out.narrowest = out.wraps ? std::min(out.width, std::max(kNarrowest, display_width(spec.name))) : out.width;
  return out;
}

int total_width(const std::vector<ConsoleColumn>& columns, bool narrowest) {
  int width = -kGutter;
  for (const ConsoleColumn& c : columns) width += kGutter + (narrowest ? c.narrowest : c.width);
  return width;
}

// Takes from the widest column that may still give, until the block fits.
void shrink(std::vector<ConsoleColumn>& columns, int limit) {
  for (int excess = total_width(columns, false) - limit; excess > 0; --excess) {
    ConsoleColumn* widest = nullptr;
    for (ConsoleColumn& c : columns)
      if (c.width > c.narrowest && (widest == nullptr || c.width > widest->width)) widest = &c;
    if (widest == nullptr) return;
    --widest->width;
  }
}

// Blocks of columns that fit, each beginning with the first column; a group is cut only when it alone is too
// wide.
std::vector<std::vector<ConsoleColumn>> split(const Table& table, int limit, bool bold) {
  const ConsoleColumn key = lay_out(table, 0, bold);
  std::vector<std::vector<ConsoleColumn>> blocks{{key}};
  for (std::size_t at = 1; at < table.columns.size();) {
    std::size_t end = at + 1;
    while (end < table.columns.size() && !table.columns[at].group.empty() &&
           table.columns[end].group == table.columns[at].group)
      ++end;
    std::vector<ConsoleColumn> group, extended = blocks.back();
    for (; at < end; ++at) group.push_back(lay_out(table, at, bold));
    extended.insert(extended.end(), group.begin(), group.end());
    if (total_width(extended, true) <= limit) {
      blocks.back() = std::move(extended);
      continue;
    }
    if (blocks.back().size() > 1) blocks.push_back({key});
    for (ConsoleColumn& column : group) {
      blocks.back().push_back(column);
      if (blocks.back().size() > 2 && total_width(blocks.back(), true) > limit) {
        blocks.back().pop_back();
        blocks.push_back({key, column});
      }
    }
  }
  return blocks;
}

void append_line(std::string& out, std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  out += line + "\n";
}

std::string padded(const std::string& text, int width, Align align) {
  return align == Align::Right ? pad_left(text, width) : pad_right(text, width);
}

void append_header(std::string& out, const Table& table, const std::vector<ConsoleColumn>& block) {
  std::string names, units;
  bool any_unit = false;
  for (const ConsoleColumn& c : block) {
    const Column& column = table.columns[c.column];
    const std::string gutter = c.column == block.front().column ? "" : std::string(kGutter, ' ');
    const std::string unit = column.unit.empty() ? "" : "[" + column.unit + "]";
    any_unit |= !unit.empty();
    names += gutter + padded(column.name, c.width, column.align);
    units += gutter + padded(unit, c.width, column.align);
  }
  append_line(out, names);
  if (any_unit) append_line(out, units);
}

// Around the text, not the blanks beside it.
std::string in_bold(const std::string& cell) {
  const std::size_t begin = cell.find_first_not_of(' '), end = cell.find_last_not_of(' ');
  if (begin == std::string::npos) return cell;
  return cell.substr(0, begin) + "\x1b[1m" + cell.substr(begin, end + 1 - begin) + "\x1b[0m" +
         cell.substr(end + 1);
}

void append_row(std::string& out, const Table& table, const std::vector<ConsoleColumn>& block,
                std::size_t row, bool bold) {
  std::vector<std::vector<std::string>> lines;
  std::size_t height = 1;
  for (const ConsoleColumn& c : block) {
    const CellText& text = c.cells[row];
    const Align align = table.columns[c.column].align;
    if (c.wraps) {
      lines.push_back(wrap_text(whole_text(text), c.width));
    } else {
      std::string line = padded(text.head, c.head, align);
      if (c.tail > 0) line.append(1, ' ').append(pad_right(text.tail, c.tail));
      lines.push_back({padded(line, c.width, align)});
    }
    height = std::max(height, lines.back().size());
  }
  for (std::size_t k = 0; k < height; ++k) {
    std::string line;
    for (std::size_t b = 0; b < block.size(); ++b) {
      if (b > 0) line.append(kGutter, ' ');
      const std::string cell = pad_right(k < lines[b].size() ? lines[b][k] : "", block[b].width);
      line += bold && table.rows[row][block[b].column].best ? in_bold(cell) : cell;
    }
    append_line(out, line);
  }
}

std::string rule(int width) {
  std::string line;
  for (int k = 0; k < width; ++k) line += "─";
  return line + "\n";
}

// "- sentence", further lines below the first word.
void append_sentences(std::string& out, const Table& table, int limit) {
  for (const std::string& line : wrap_text(one_line(table.title), limit)) append_line(out, line);
  for (const std::string& sentence : sentences_of(table)) {
    const char* begin = "- ";
    for (const std::string& line : wrap_text(one_line(sentence), std::max(limit - 2, 10))) {
      append_line(out, begin + line);
      begin = "  ";
    }
  }
  for (const std::string& note : table.notes)
    for (const std::string& line : wrap_text(one_line(note), limit)) append_line(out, line);
}

void append_table(std::string& out, const Table& table, int limit, bool bold, bool explain) {
  if (!table.sentences.empty()) return append_sentences(out, table, limit);
  for (const std::string& line : wrap_text(one_line(table.title), limit)) append_line(out, line);
  std::vector<std::vector<ConsoleColumn>> blocks = split(table, limit, bold);
  std::vector<int> widths;
  for (std::vector<ConsoleColumn>& block : blocks) {
    shrink(block, limit);
    widths.push_back(total_width(block, false));
  }
  out += rule(widths.front());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    append_header(out, table, blocks[b]);
    out += rule(widths[b]);
    for (std::size_t row = 0; row < table.rows.size(); ++row) append_row(out, table, blocks[b], row, bold);
    out += rule(b + 1 < blocks.size() ? std::max(widths[b], widths[b + 1]) : widths[b]);
  }
  if (explain) append_line(out, kStarNote);
  for (const std::string& note : table.notes)
    for (const std::string& line : wrap_text(one_line(note), limit)) append_line(out, line);
}

bool any_best(const Table& table) {
  for (const auto& row : table.rows)
    for (const Cell& cell : row)
      if (cell.best) return true;
  return false;
}

}  // namespace

std::string render_console(const std::vector<Table>& tables, const RenderOptions& options) {
  const int limit = options.width > 0 ? options.width : std::numeric_limits<int>::max() / 4;
  std::string out;
  bool explained = options.bold;
  for (const Table& table : tables) {
    if (!out.empty()) out += "\n";
    const bool explain = !explained && any_best(table);
    append_table(out, table, limit, options.bold, explain);
    explained = explained || explain;
  }
  return out;
}

}  // namespace odobench
