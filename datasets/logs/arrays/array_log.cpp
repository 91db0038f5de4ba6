#include "datasets/logs/arrays/array_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/files.hpp"
#include "base/range.hpp"
#include "base/text.hpp"
#include "datasets/logs/arrays/array_catalogue.hpp"
#include "datasets/logs/log_names.hpp"
#include "datasets/logs/log_time.hpp"

namespace odobench {
namespace {

constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

// Where a column of an array goes: into column `value` of table `request`, or, as its time, kNowhere.
struct ColumnUse {
  std::size_t column, request, value;
};

struct ArrayRequest {
  std::string time_path;
  TimeUnit unit{"s"};
  std::size_t rows = 0;
};

// Puts the wanted columns into the tables.
class ColumnReader : public ArrayVisitor {
 public:
  ColumnReader(std::string file, const std::vector<ArrayInfo>& arrays,
               const std::map<std::size_t, std::vector<ColumnUse>>& uses,
               const std::vector<ArrayRequest>& requests, std::vector<LogTable>& tables)
      : file_(std::move(file)), arrays_(arrays), uses_(uses), requests_(requests), tables_(tables) {}

  bool begin(const ArrayHead& head) override {
    const std::size_t at = next_++;
    if (at >= arrays_.size() || arrays_[at].head.name != head.name || arrays_[at].head.rows != head.rows ||
        arrays_[at].head.columns != head.columns)
      throw DataError(fmt::format("{}: changed while it was read", file_));
    head_ = head;
    taken_ = 0;
    const auto found = uses_.find(at);
    current_ = found == uses_.end() ? nullptr : &found->second;
    return current_ != nullptr;
  }

  void skip(const std::string&, const std::string&) override {}

  void numbers(const std::int64_t* whole, const double* real, std::size_t count) override {
    for (const ColumnUse& use : *current_) {
      if (head_.by_rows) {
        const std::size_t width = head_.columns, into = taken_ % width;
        for (std::size_t i = (use.column + width - into) % width; i < count; i += width)
          put(use, whole, real, i);
      } else {
        const std::size_t begin = use.column * head_.rows, end = begin + head_.rows;
        const std::size_t first = std::max(begin, taken_), last = std::min(end, taken_ + count);
        for (std::size_t i = first; i < last; ++i) put(use, whole, real, i - taken_);
      }
    }
    taken_ += count;
  }

 private:
  void put(const ColumnUse& use, const std::int64_t* whole, const double* real, std::size_t i) {
    LogTable& table = tables_[use.request];
    if (use.value != kNowhere) {
      const double value = whole != nullptr ? static_cast<double>(whole[i]) : real[i];
      table.values[use.value].push_back(value);
      if (!in_range(value) && !std::isnan(value))
        fail(fmt::format("row {}: found {}, expected a number of at most {:g} in size",
                         table.values[use.value].size(), value, kLargestNumber));
      return;
    }
    const TimeUnit& unit = requests_[use.request].unit;
    const auto stamp = whole != nullptr ? unit.of(whole[i]) : unit.of(real[i]);
    std::vector<std::int64_t>& times = table.time_ns;
    if (!stamp) fail(fmt::format("row {}: no {}", times.size() + 1, unit.text().substr(2)));
    if (!times.empty() && *stamp < times.back())
      fail(fmt::format("row {}: time goes back by {:.3f} s", times.size() + 1,
                       static_cast<double>(times.back() - *stamp) * 1e-9));
    times.push_back(*stamp);
  }
  [[noreturn]] void fail(const std::string& message) const {
    throw DataError(fmt::format("{}: {}: {}", file_, shown(head_.name), message));
  }

  std::string file_;
  const std::vector<ArrayInfo>& arrays_;
  const std::map<std::size_t, std::vector<ColumnUse>>& uses_;
  const std::vector<ArrayRequest>& requests_;
  std::vector<LogTable>& tables_;
  const std::vector<ColumnUse>* current_ = nullptr;
  ArrayHead head_;
  std::size_t next_ = 0, taken_ = 0;
};

class ArrayLog : public LogFile {
 public:
  ArrayLog(std::filesystem::path file, std::string format, ArrayGrouping grouping, ArrayWalk walk)
      : file_(std::move(file)), format_(std::move(format)), grouping_(grouping), walk_(std::move(walk)) {}

  std::string format() const override { return format_; }

  std::vector<LogSource> sources(const Stop& stop) const override {
    const ArrayCatalogue catalogue = look(stop);
    std::vector<LogSource> sources;
    for (const std::string& name : catalogue.sources()) sources.push_back(catalogue.describe(name));
    for (const auto& [name, reason] : catalogue.skipped()) {
      sources.emplace_back();
      sources.back().name = name;
      sources.back().type = "array";
      sources.back().unreadable = reason;
    }
    return sources;
  }

  std::vector<LogTable> read(const std::vector<LogRequest>& requests, const Stop& stop) const override {
    const ArrayCatalogue catalogue = look(stop);
    std::vector<LogTable> tables(requests.size());
    std::vector<ArrayRequest> plans;
    std::map<std::size_t, std::vector<ColumnUse>> uses;
    std::size_t kept = 0;
    for (std::size_t r = 0; r < requests.size(); ++r) {
      plans.push_back(plan(catalogue, requests[r], r, uses, tables[r]));
      kept += plans[r].rows * (1 + requests[r].fields.size());
      if (kept > static_cast<std::size_t>(kMostValues)) refuse_too_many_values(shown_path(file_));
    }
    ColumnReader reader(shown_path(file_), catalogue.arrays(), uses, plans, tables);
    walk_(reader, stop);
    return tables;
  }

 private:
  ArrayCatalogue look(const Stop& stop) const {
    ArrayCatalogue catalogue(shown_path(file_));
    walk_(catalogue, stop);
    catalogue.group(grouping_);
    return catalogue;
  }
  std::pair<std::size_t, std::size_t> find(const ArrayCatalogue& catalogue, const std::string& source,
                                           const std::string& path) const;
  ArrayRequest plan(const ArrayCatalogue& catalogue, const LogRequest& request, std::size_t number,
                    std::map<std::size_t, std::vector<ColumnUse>>& uses, LogTable& table) const;
  std::size_t find_time(const ArrayCatalogue& catalogue, const LogRequest& request, std::string& unit) const;

  std::filesystem::path file_;
  std::string format_;
  ArrayGrouping grouping_;
  ArrayWalk walk_;
};

// Array and column of a path.
std::pair<std::size_t, std::size_t> ArrayLog::find(const ArrayCatalogue& catalogue, const std::string& source,
                                                   const std::string& path) const {
  for (const auto& [name, reason] : catalogue.skipped())
    if (name == source || name == (source.empty() ? path : source + "." + path))
      throw DataError(fmt::format("{}: {}: {}", shown_path(file_), shown(name), reason));
  const std::vector<std::string> sources = catalogue.sources();
  if (std::find(sources.begin(), sources.end(), source) == sources.end())
    refuse_unknown("source", source, shown_path(file_), sources);
  for (std::size_t i = 0; i < catalogue.arrays().size(); ++i) {
    const ArrayInfo& array = catalogue.arrays()[i];
    if (array.source != source) continue;
    for (std::size_t c = 0; c < array.head.columns; ++c)
      if (field_path(array, c) == path) return {i, c};
  }
  refuse_unknown("field", path, source.empty() ? shown_path(file_) : shown(source), catalogue.fields(source));
}

std::size_t ArrayLog::find_time(const ArrayCatalogue& catalogue, const LogRequest& request,
                                std::string& unit) const {
  unit = request.time_unit;
  std::string told;
  if (request.time.empty()) {
    const std::optional<std::size_t> time = catalogue.time(request.source, told);
    if (!time)
      throw std::invalid_argument(
          fmt::format("{}: found no vector in '{}' that tells time, expected \"time\" and "
                      "\"time_unit\"",
                      shown_path(file_), shown(request.source)));
    if (unit.empty()) unit = told;
    return *time;
  }
  const auto [array, column] = find(catalogue, request.source, request.time);
  const ArrayInfo& info = catalogue.arrays()[array];
  if (info.head.columns != 1)
    throw std::invalid_argument(fmt::format("{}: '{}' has {} columns, expected a vector as time",
                                            shown_path(file_), shown(request.time), info.head.columns));
  if (unit.empty()) unit = time_unit_of_name(info.field);
  if (unit.empty()) unit = time_unit_of_values(info.samples);
  if (unit.empty())
    throw std::invalid_argument(
        fmt::format("{}: '{}' does not tell its unit of time by name or size, expected "
                    "\"time_unit\"",
                    shown_path(file_), shown(request.time)));
  return array;
}

ArrayRequest ArrayLog::plan(const ArrayCatalogue& catalogue, const LogRequest& request, std::size_t number,
                            std::map<std::size_t, std::vector<ColumnUse>>& uses, LogTable& table) const {
  for (const std::string& path : request.text) {
    find(catalogue, request.source, path);
    throw std::invalid_argument(
        fmt::format("{}: '{}' holds numbers, expected a text", shown_path(file_), shown(path)));
  }
  for (const std::string& path : request.fields) find(catalogue, request.source, path);
  std::string unit;
  const std::size_t time = find_time(catalogue, request, unit);
  ArrayRequest plan;
  plan.unit = TimeUnit(unit);
  plan.rows = catalogue.arrays()[time].head.rows;
  uses[time].push_back({0, number, kNowhere});
  table.values.resize(request.fields.size());
  for (std::size_t i = 0; i < request.fields.size(); ++i) {
    const auto [array, column] = find(catalogue, request.source, request.fields[i]);
    const ArrayInfo& info = catalogue.arrays()[array];
    if (info.head.rows != plan.rows)
      throw DataError(fmt::format("{}: {} has {}, expected {} as in {}", shown_path(file_),
                                  shown(info.head.name),
                                  counted(static_cast<std::int64_t>(info.head.rows), "row"), plan.rows,
                                  shown(catalogue.arrays()[time].head.name)));
    uses[array].push_back({column, number, i});
  }
  if (request.time.empty() || request.time_unit.empty())
    table.notes.push_back(
        fmt::format("time: '{}' taken as {}", catalogue.arrays()[time].field, plan.unit.text()));
  return plan;
}

}  // namespace

std::unique_ptr<LogFile> open_arrays(const std::filesystem::path& file, std::string format,
                                     ArrayGrouping grouping, ArrayWalk walk) {
  return std::make_unique<ArrayLog>(file, std::move(format), grouping, std::move(walk));
}

}  // namespace odobench
