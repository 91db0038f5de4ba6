#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/csv/text_lines.hpp"
#include "datasets/logs/tables/table_layout.hpp"

namespace odobench {
namespace {

constexpr std::size_t kMostLines = 64, kMostComments = 1000;
constexpr std::size_t kRowsForSeparator = 50;

std::string as_utf8(std::string_view text, bool& latin1) {
  if (is_valid_utf8(text)) return std::string(text);
  latin1 = true;
  return latin1_to_utf8(text);
}

// How well a separator fits: the share of lines with the most frequent count of fields, times the share of
// numbers in them.
double fit(const TableHead& head, char separator) {
  std::map<std::size_t, std::size_t> counts;
  std::size_t numbers = 0, fields = 0, lines = 0;
  const std::size_t first = head.lines.size() > kRowsForSeparator ? head.lines.size() - kRowsForSeparator : 0;
  for (std::size_t i = first; i < head.lines.size(); ++i, ++lines) {
    const std::vector<std::string> row = table_fields(head.lines[i].text, separator);
    ++counts[row.size()];
    fields += row.size();
    numbers += static_cast<std::size_t>(std::count_if(row.begin(), row.end(), [&](const std::string& field) {
      return number_or_nothing(field) && !(separator == ',' && field.find(',') != std::string::npos);
    }));
  }
  const auto most = std::max_element(counts.begin(), counts.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == counts.end() || most->first < 2) return 0;
  const double same = static_cast<double>(most->second) / static_cast<double>(lines);
  return same * (0.05 + static_cast<double>(numbers) / static_cast<double>(fields));
}

}  // namespace

std::string latin1_to_utf8(std::string_view text) {
  std::string utf8;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (u < 0x80) {
      utf8 += c;
    } else {
      utf8 += static_cast<char>(0xC0 | (u >> 6));
      utf8 += static_cast<char>(0x80 | (u & 0x3F));
    }
  }
  return utf8;
}

bool stands_for_nothing(std::string_view field) {
  if (field.empty()) return true;
  if (field.size() > 4) return false;
  std::string lower(field);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c; });
  constexpr std::array<std::string_view, 8> words{"nan", "-nan", "na", "n/a", "null", "none", "-", "#n/a"};
  return std::find(words.begin(), words.end(), lower) != words.end();
}

bool number_or_nothing(std::string_view field) {
  return looks_like_number(field) || stands_for_nothing(field);
}

std::vector<std::string> table_fields(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  std::deque<std::string> unescaped;
  if (separator == ' ') line = without_blanks(line);
  std::vector<std::string> result;
  if (!split_fields(line, separator, fields, unescaped)) return {std::string(line)};
  for (const std::string_view field : fields) result.emplace_back(field);
  return result;
}

std::vector<std::vector<std::string>> TableHead::rows(char separator) const {
  std::vector<std::vector<std::string>> result;
  for (const Line& line : lines) result.push_back(table_fields(line.text, separator));
  return result;
}

TableHead read_table_head(const std::filesystem::path& file, const std::string& marks) {
  TableHead head;
  TextLines text(file);
  std::string_view line;
  std::size_t bytes = 0;
  while (head.lines.size() < kMostLines && bytes < TextLines::kLongestLine && text.next(line)) {
    if (text.line() == 1 && line.substr(0, 3) == "\xEF\xBB\xBF") line.remove_prefix(3);
    bytes += line.size() + 1;
    const std::string fault = encoding_fault(line);
    if (!fault.empty()) throw DataError(fmt::format("{}:{}: {}", shown_path(file), text.line(), fault));
    const std::string_view content = without_blanks(line);
    if (content.empty()) continue;
    if (text.line() == 1) {
      char separator = ',';
      if (separator_line(line, separator)) {
        head.declared = separator;
        continue;
      }
    }
    if (marks.find(content.front()) != std::string::npos) {
      if (head.comments.size() < kMostComments && head.lines.empty())
        head.comments.push_back(
            {text.line(), as_utf8(content.substr(std::min(content.find_first_not_of(marks), content.size())),
                                  head.latin1)});
      continue;
    }
    head.lines.push_back({text.line(), as_utf8(line, head.latin1)});
  }
  return head;
}

char find_table_separator(const TableHead& head) {
  if (head.declared != 0) return head.declared;
  char best = ',';
  double best_fit = 0;
  for (const char separator : {';', '\t', ',', '|', ' '}) {
    const double now = fit(head, separator);
    if (now > best_fit) {
      best = separator;
      best_fit = now;
    }
  }
  return best;
}

}  // namespace odobench
