// Rows of a text as fields, of which only some columns are wanted: the others are passed over.
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/stop.hpp"
#include "datasets/csv/text_lines.hpp"
#include "datasets/logs/tables/table_layout.hpp"

namespace odobench {

class TableRows {
 public:
  // `wanted`: columns in increasing order. `keep_cut`: a last row that is cut off ends the rows. `layout`
  // must outlive this.
  TableRows(const std::filesystem::path& file, const TableLayout& layout, std::vector<std::size_t> wanted,
            bool keep_cut, const Stop& stop);

  // To the next row; false at the end. DataError "FILE:LINE: found 4 fields, expected 5". Throws Interruption
  // when asked to stop.
  bool next();
  // Of the k-th wanted column; valid until next().
  std::string_view field(std::size_t k) const { return fields_[k]; }
  // As a number; empty fields, "nan", "NA" and the like are NaN. DataError "FILE:LINE: field 3 'links': 'x'
  // is no number".
  double number(std::size_t k) const;
  std::size_t line() const { return lines_.line(); }
  bool cut() const { return cut_; }  // the last row was left out

  [[noreturn]] void fail(const std::string& message) const;
  // DataError "FILE:LINE: field 3 'links': 'x' MESSAGE" of the k-th wanted column.
  [[noreturn]] void fail_field(std::size_t k, const std::string& message) const;

 private:
  bool split(std::string_view line);
  std::size_t split_plain(std::string_view line);
  std::size_t split_blanks(std::string_view line);
  std::size_t split_quoted(std::string_view line);
  double unusual_number(std::size_t k) const;

  TextLines lines_;
  const TableLayout& layout_;
  std::vector<std::size_t> wanted_;
  bool keep_cut_, cut_ = false, open_end_ = false;
  std::vector<std::string_view> fields_, all_;
  std::deque<std::string> unescaped_;
  std::string shown_name_;
};

}  // namespace odobench
