#include "datasets/logs/tables/table_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/logs/log_names.hpp"
#include "datasets/logs/log_time.hpp"
#include "datasets/logs/tables/table_rows.hpp"

namespace odobench {
namespace {

constexpr std::size_t kNone = TableLayout::npos;

// One line per row of the table: its time.
std::vector<std::int64_t> read_times_file(const std::filesystem::path& file, const Stop& stop) {
  std::vector<std::int64_t> times;
  TableLayout layout;
  layout.names = {"time"};
  layout.separator = ' ';
  TableRows rows(file, layout, {0}, false, stop);
  const TimeUnit seconds("s");
  while (rows.next()) {
    const std::optional<std::int64_t> stamp = seconds.of(rows.field(0));
    if (!stamp) rows.fail_field(0, "is no time in s");
    times.push_back(*stamp);
  }
  return times;
}

// What one request wants of each row. Columns are places among the wanted ones.
struct RowPlan {
  struct Value {
    std::vector<std::size_t> places;
    std::function<double(const double*)> compute;
  };
  std::size_t time = kNone;
  TimeUnit unit{"s"};
  std::vector<Value> values;
  std::vector<std::size_t> texts;
  LogTable table;
  std::int64_t no_time = 0, no_value = 0;
  std::size_t last_line = 0;
};

class TableLog : public LogFile {
 public:
  TableLog(std::filesystem::path file, TableLayout layout, bool keep_cut)
      : file_(std::move(file)), layout_(std::move(layout)), keep_cut_(keep_cut) {}

  std::string format() const override { return layout_.format; }
  std::vector<LogSource> sources(const Stop& stop) const override;
  std::vector<LogTable> read(const std::vector<LogRequest>& requests, const Stop& stop) const override;

 private:
  std::size_t column(const std::string& name) const;
  const TableSource& source(const std::string& name) const;
  const TableField* find_field(const TableSource& source, const std::string& path) const;
  const TableField& field(const TableSource& source, const std::string& path) const;
  std::string unit_of(std::size_t column, const std::string& given) const;
  std::vector<std::size_t> columns_of(const LogRequest& request) const;
  RowPlan plan(const LogRequest& request, const std::vector<std::size_t>& wanted) const;
  void take_row(RowPlan& plan, const TableRows& rows, const std::vector<std::int64_t>& times,
                std::size_t row) const;
  void finish(RowPlan& plan, const TableRows& rows) const;

  std::filesystem::path file_;
  TableLayout layout_;
  bool keep_cut_;
};

const TableSource& TableLog::source(const std::string& name) const {
  std::vector<std::string> names;
  for (const TableSource& source : layout_.sources) {
    if (source.name == name) return source;
    names.push_back(source.name);
  }
  refuse_unknown("source", name, shown_path(file_), names);
}

// By its name, or "#3" also where it has another.
std::size_t TableLog::column(const std::string& name) const {
  const auto found = std::find(layout_.names.begin(), layout_.names.end(), name);
  if (found != layout_.names.end()) return static_cast<std::size_t>(found - layout_.names.begin());
  for (std::size_t c = 0; c < layout_.names.size() && name.size() > 1 && name[0] == '#'; ++c)
    if (name == fmt::format("#{}", c + 1)) return c;
  return kNone;
}

const TableField* TableLog::find_field(const TableSource& source, const std::string& path) const {
  for (const TableField& field : source.fields)
    if (field.info.path == path) return &field;
  const std::size_t place = column(path);
  if (place == kNone) return nullptr;
  for (const TableField& field : source.fields)
    if (!field.value && field.columns[0] == place) return &field;
  return nullptr;
}

const TableField& TableLog::field(const TableSource& source, const std::string& path) const {
  if (const TableField* found = find_field(source, path)) return *found;
  std::vector<std::string> names;
  for (const TableField& field : source.fields) names.push_back(field.info.path);
  refuse_unknown("field", path, shown_path(file_), names);
}

// The unit of a column of time: given, of its name, or of its first values.
std::string TableLog::unit_of(std::size_t column, const std::string& given) const {
  if (!given.empty()) return given;
  if (column == layout_.time) return layout_.time_unit;
  std::string unit = time_unit_of_name(layout_.names[column]);
  if (!unit.empty()) return unit;
  std::vector<std::string> values;
  TableRows rows(file_, layout_, {column}, keep_cut_, Stop());
  while (values.size() < 50 && rows.next())
    if (!rows.field(0).empty()) values.emplace_back(rows.field(0));
  unit = time_unit_of_values(values);
  if (unit.empty())
    throw std::invalid_argument(
        fmt::format("{}: column '{}' does not tell its unit of time by name or size, "
                    "expected \"time_unit\"",
                    shown_path(file_), shown(layout_.names[column])));
  return unit;
}

std::vector<std::size_t> TableLog::columns_of(const LogRequest& request) const {
  const TableSource& from = source(request.source);
  std::vector<std::size_t> columns;
  for (const std::string& path : request.fields) {
    const TableField& wanted = field(from, path);
    columns.insert(columns.end(), wanted.columns.begin(), wanted.columns.end());
  }
  for (const std::string& path : request.text) columns.push_back(field(from, path).columns[0]);
  std::size_t time = layout_.time;
  if (!request.time.empty()) {
    time = column(request.time);
    if (time == kNone) refuse_unknown("column", request.time, shown_path(file_), layout_.names);
  } else if (!layout_.times_file.empty()) {
    return columns;
  }
  if (time == kNone)
    throw std::invalid_argument(
        fmt::format("{}: found no column that tells time, expected \"time\" and "
                    "\"time_unit\"",
                    shown_path(file_)));
  columns.push_back(time);  // always the last one
  return columns;
}

RowPlan TableLog::plan(const LogRequest& request, const std::vector<std::size_t>& wanted) const {
  const auto place = [&](std::size_t column) {
    return static_cast<std::size_t>(std::lower_bound(wanted.begin(), wanted.end(), column) - wanted.begin());
  };
  const TableSource& from = source(request.source);
  RowPlan plan;
  for (const std::string& path : request.fields) {
    const TableField& wanted_field = field(from, path);
    RowPlan::Value value{{}, wanted_field.value};
    for (const std::size_t column : wanted_field.columns) value.places.push_back(place(column));
    plan.values.push_back(value);
  }
  for (const std::string& path : request.text) plan.texts.push_back(place(field(from, path).columns[0]));
  if (!request.time.empty() || layout_.times_file.empty()) {
    const std::size_t column = columns_of(request).back();
    plan.time = place(column);
    plan.unit = TimeUnit(unit_of(column, request.time_unit));
  }
  plan.table.values.resize(plan.values.size());
  plan.table.text.resize(plan.texts.size());
  plan.table.notes = layout_.notes;
  return plan;
}

void TableLog::take_row(RowPlan& plan, const TableRows& rows, const std::vector<std::int64_t>& times,
                        std::size_t row) const {
  constexpr std::size_t most_arguments = 16;
  std::optional<std::int64_t> stamp;
  if (plan.time == kNone) {
    stamp = times[row];
  } else if (rows.field(plan.time).empty()) {
    ++plan.no_time;
    return;
  } else {
    stamp = plan.unit.of(rows.field(plan.time));
    if (!stamp) rows.fail_field(plan.time, fmt::format("is no {}", plan.unit.text().substr(2)));
  }
  bool any = plan.values.empty() && plan.texts.empty();
  for (std::size_t i = 0; i < plan.values.size(); ++i) {
    const RowPlan::Value& wanted = plan.values[i];
    double arguments[most_arguments] = {};
    for (std::size_t k = 0; k < wanted.places.size(); ++k) arguments[k] = rows.number(wanted.places[k]);
    const double value = wanted.compute ? wanted.compute(arguments) : arguments[0];
    any = any || !std::isnan(value);
    plan.table.values[i].push_back(value);
  }
  for (const std::size_t place : plan.texts) any = any || !rows.field(place).empty();
  if (!any) {
    for (std::vector<double>& column : plan.table.values) column.pop_back();
    ++plan.no_value;
    return;
  }
  for (std::size_t i = 0; i < plan.texts.size(); ++i) {
    const std::string_view text = rows.field(plan.texts[i]);
    plan.table.text[i].push_back(is_valid_utf8(text) ? std::string(text) : latin1_to_utf8(text));
  }
  if (!plan.table.time_ns.empty() && *stamp < plan.table.time_ns.back())
    rows.fail(fmt::format("time goes back by {:.3f} s",
                          static_cast<double>(plan.table.time_ns.back() - *stamp) * 1e-9));
  plan.table.time_ns.push_back(*stamp);
}

void TableLog::finish(RowPlan& plan, const TableRows& rows) const {
  if (plan.no_time > 0)
    plan.table.notes.push_back(counted(plan.no_time, "row") + " without a time passed over");
  if (plan.no_value > 0)
    plan.table.notes.push_back(counted(plan.no_value, "row") + " without any of these values passed over");
  if (rows.cut()) plan.table.notes.push_back(fmt::format("line {} is cut off and left out", rows.line()));
}

std::vector<LogTable> TableLog::read(const std::vector<LogRequest>& requests, const Stop& stop) const {
  std::vector<std::size_t> wanted;
  for (const LogRequest& request : requests) {
    const std::vector<std::size_t> columns = columns_of(request);
    wanted.insert(wanted.end(), columns.begin(), columns.end());
  }
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::vector<RowPlan> plans;
  std::int64_t per_row = 0, kept = 0;
  for (const LogRequest& request : requests) {
    plans.push_back(plan(request, wanted));
    per_row += 1 + static_cast<std::int64_t>(request.fields.size() + request.text.size());
  }
  std::vector<std::int64_t> times;
  if (!layout_.times_file.empty()) times = read_times_file(layout_.times_file, stop);
  TableRows rows(file_, layout_, wanted, keep_cut_, stop);
  std::size_t row = 0;
  for (; rows.next(); ++row) {
    if (!layout_.times_file.empty() && row >= times.size())
      rows.fail(fmt::format("found no time for this row: {} has only {}", shown_path(layout_.times_file),
                            counted(static_cast<std::int64_t>(times.size()), "line")));
    if ((kept += per_row) > kMostValues) refuse_too_many_values(shown_path(file_));
    for (RowPlan& plan : plans) take_row(plan, rows, times, row);
  }
  if (row < times.size())
    throw DataError(fmt::format("{}: found {}, expected {} as in {}", shown_path(file_),
                                counted(static_cast<std::int64_t>(row), "row"), times.size(),
                                shown_path(layout_.times_file)));
  std::vector<LogTable> tables;
  for (RowPlan& plan : plans) {
    finish(plan, rows);
    tables.push_back(std::move(plan.table));
  }
  return tables;
}

std::vector<LogSource> TableLog::sources(const Stop& stop) const {
  const bool timed = layout_.time != kNone && layout_.times_file.empty();
  std::vector<std::int64_t> times;
  if (!layout_.times_file.empty()) times = read_times_file(layout_.times_file, stop);
  std::vector<std::size_t> wanted;
  if (timed) wanted.push_back(layout_.time);
  TableRows rows(file_, layout_, wanted, keep_cut_, stop);
  const TimeUnit unit(timed ? layout_.time_unit : "s");
  RowTimes stamps;
  std::int64_t count = 0;
  for (; rows.next(); ++count) {
    if (timed)
      if (const std::optional<std::int64_t> stamp = unit.of(rows.field(0))) stamps.add(*stamp);
  }
  for (const std::int64_t stamp : times) stamps.add(stamp);
  std::vector<LogSource> sources;
  for (const TableSource& from : layout_.sources) {
    LogSource source;
    source.name = from.name;
    source.type = from.type;
    for (const TableField& field : from.fields) source.fields.push_back(field.info);
    source.rows = count;
    stamps.give(source);
    sources.push_back(std::move(source));
  }
  return sources;
}

bool is_text(const std::filesystem::path&, const std::string& head) {
  const bool utf16 = head.substr(0, 2) == "\xFF\xFE" || head.substr(0, 2) == "\xFE\xFF";  // its refusal helps
  return utf16 || (!head.empty() && head.find('\0') == std::string::npos);
}

}  // namespace

std::unique_ptr<LogFile> open_table(const std::filesystem::path& file, TableLayout layout, bool keep_cut) {
  return std::make_unique<TableLog>(file, std::move(layout), keep_cut);
}

LogFormat csv_log_format() {
  return {"CSV", is_text, [](const std::filesystem::path& file, const LogOptions& options) {
            return open_table(file, find_table_layout(file, options), options.keep_cut);
          }};
}

}  // namespace odobench
