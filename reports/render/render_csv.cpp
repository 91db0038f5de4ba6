#include <fmt/format.h>

#include <charconv>
#include <string_view>
#include <system_error>

#include "reports/render/table.hpp"

namespace odobench {

namespace {

bool is_number(const std::string& text) {
  double value = 0;
  const char* const begin = text.data() + (text.front() == '+' ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

// A spreadsheet would compute what begins like this: the usual apostrophe makes it text. Numbers and a lone
// dash are harmless.
std::string guarded(const std::string& text) {
  if (text.size() < 2 || std::string_view("=+-@").find(text.front()) == std::string_view::npos) return text;
  return is_number(text) ? text : "'" + text;
}

}  // namespace

std::string csv_field(const std::string& text) {
  const bool plain = text.find_first_of(",\"\r\n") == std::string::npos &&
                     (text.empty() || (text.front() != ' ' && text.back() != ' '));
  if (plain) return text;
  std::string out = "\"";
  for (char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

namespace {

// The shortest text that reads back as the same bits.
std::string exact(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "";
}

struct Extras {
  bool difference = false, mark = false;
};

std::vector<Extras> extras_of(const Table& table) {
  std::vector<Extras> extras(table.columns.size());
  for (const auto& row : table.rows)
    for (std::size_t c = 0; c < row.size(); ++c) {
      extras[c].difference |= row[c].difference.has_value();
      extras[c].mark |= !row[c].mark.empty();
    }
  return extras;
}

std::string line_of(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if (k > 0) line += ',';
    line += csv_field(fields[k]);
  }
  return line + "\r\n";
}

std::vector<std::string> header(const Table& table, const std::vector<Extras>& extras) {
  std::vector<std::string> fields;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Column& column = table.columns[c];
    const std::string unit = column.unit.empty() ? "" : " [" + column.unit + "]";
    fields.push_back(column.id + unit);
    if (extras[c].difference) fields.push_back(column.id + "_difference" + unit);
    if (extras[c].mark) fields.push_back(column.id + "_" + column.mark_name);
  }
  return fields;
}

}  // namespace

std::string render_csv(const std::vector<Table>& tables) {
  std::string out;
  for (const Table& table : tables) {
    if (!out.empty()) out += "\r\n";
    const std::vector<Extras> extras = extras_of(table);
    out += line_of({"#table", table.id, guarded(table.title)});
    out += line_of(header(table, extras));
    for (const auto& row : table.rows) {
      std::vector<std::string> fields;
      for (std::size_t c = 0; c < row.size(); ++c) {
        fields.push_back(row[c].value ? exact(row[c].value) : guarded(row[c].text));
        if (extras[c].difference) fields.push_back(exact(row[c].difference));
        if (extras[c].mark) fields.push_back(guarded(row[c].mark));
      }
      out += line_of(fields);
    }
    for (const std::string& note : table.notes) out += line_of({"#note", guarded(note)});
  }
  return out;
}

}  // namespace odobench
