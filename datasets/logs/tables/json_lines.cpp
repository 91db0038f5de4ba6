#include "datasets/logs/tables/json_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "base/files.hpp"
#include "base/json_node.hpp"
#include "base/range.hpp"
#include "base/text.hpp"
#include "datasets/csv/csv_dialect.hpp"
#include "datasets/csv/text_lines.hpp"
#include "datasets/logs/log_names.hpp"
#include "datasets/logs/log_time.hpp"
#include "datasets/logs/tables/json_paths.hpp"
#include "datasets/logs/tables/json_topics.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;

// What one request takes out of each line of its topic.
struct LinePlan {
  const LogRequest* request = nullptr;
  std::string time_path;
  TimeUnit unit{"s"};
  std::size_t time = 0;
  std::vector<std::size_t> fields, texts;
  std::vector<bool> seen;  // of fields and texts: any line had it
  LogTable table;
  std::int64_t no_time = 0, no_value = 0;
  bool topic_seen = false;
};

class JsonLinesLog : public LogFile {
 public:
  JsonLinesLog(fs::path file, bool keep_cut) : file_(std::move(file)), keep_cut_(keep_cut) {}

  std::string format() const override { return "JSON lines"; }
  std::vector<LogSource> sources(const Stop& stop) const override {
    JsonTopics topics(file_);
    for_lines(topics.paths(), stop, [&](const JsonPaths&, std::size_t) {
      topics.take_line();
      return true;
    });
    return topics.sources();
  }
  std::vector<LogTable> read(const std::vector<LogRequest>& requests, const Stop& stop) const override;

 private:
  // Calls take(paths, line) after each line; false ends it. The note of a cut last line, or "".
  template <class Take>
  std::string for_lines(JsonPaths& paths, const Stop& stop, Take take) const;
  LinePlan plan(const LogRequest& request, JsonPaths& paths, const Stop& stop) const;
  void take_line(LinePlan& plan, const JsonPaths& paths, std::size_t line) const;
  void require_seen(const LinePlan& plan, const Stop& stop) const;
  [[noreturn]] void fail(std::size_t line, const std::string& message) const {
    throw DataError(fmt::format("{}:{}: {}", shown_path(file_), line, message));
  }

  fs::path file_;
  bool keep_cut_;
};

template <class Take>
std::string JsonLinesLog::for_lines(JsonPaths& paths, const Stop& stop, Take take) const {
  TextLines lines(file_, stop.flag());
  const std::string name = shown_path(file_);
  std::string_view line;
  while (lines.next(line)) {
    if (lines.line() == 1 && line.substr(0, 3) == "\xEF\xBB\xBF") line.remove_prefix(3);
    if (without_blanks(line).empty()) continue;
    try {
      paths.parse(line, name, lines.line());
    } catch (const JsonEndsEarly&) {
      if (!lines.unfinished()) throw;
      if (keep_cut_) return fmt::format("line {} is cut off and left out", lines.line());
      fail(lines.line(), "found the end of the file inside a value: the file is cut off");
    }
    if (!take(paths, lines.line())) return "";
  }
  if (lines.interrupted()) throw Interruption();
  return "";
}

LinePlan JsonLinesLog::plan(const LogRequest& request, JsonPaths& paths, const Stop& stop) const {
  LinePlan plan;
  plan.request = &request;
  plan.time_path = request.time;
  std::string unit = request.time_unit;
  if (plan.time_path.empty() || unit.empty()) {
    JsonTopics topics(file_);  // the first lines tell
    for_lines(topics.paths(), stop, [&](const JsonPaths&, std::size_t) {
      topics.take_line();
      return !topics.decided(request.source);
    });
    topics.find_time(request.source, plan.time_path, unit);
  }
  plan.unit = TimeUnit(unit);
  plan.time = paths.add(plan.time_path, true);
  for (const std::string& path : request.fields) plan.fields.push_back(paths.add(path, false));
  for (const std::string& path : request.text) plan.texts.push_back(paths.add(path, true));
  plan.seen.resize(plan.fields.size() + plan.texts.size());
  plan.table.values.resize(plan.fields.size());
  plan.table.text.resize(plan.texts.size());
  return plan;
}

void JsonLinesLog::take_line(LinePlan& plan, const JsonPaths& paths, std::size_t line) const {
  plan.topic_seen = true;
  if (plan.time == JsonPaths::kNone || !paths.has(plan.time)) {
    ++plan.no_time;
    return;
  }
  const std::optional<std::int64_t> stamp = stamp_of(paths.leaf(plan.time), plan.unit);
  if (!stamp)
    fail(line, fmt::format("field '{}' is no {}", shown(plan.time_path), plan.unit.text().substr(2)));
  bool any = plan.seen.empty();
  for (std::size_t i = 0; i < plan.fields.size(); ++i) {
    const std::size_t node = plan.fields[i];
    double value = kNotANumber;
    if (node != JsonPaths::kNone && paths.has(node)) {
      if (paths.leaf(node).kind == JsonLeaf::Kind::Text)
        fail(line, fmt::format("field '{}' is no number", shown(plan.request->fields[i])));
      value = paths.leaf(node).real;
      if (!in_range(value))
        fail(line, fmt::format("field '{}' is no number of at most {:g} in size",
                               shown(plan.request->fields[i]), kLargestNumber));
      any = plan.seen[i] = true;
    }
    plan.table.values[i].push_back(value);
  }
  for (std::size_t i = 0; i < plan.texts.size(); ++i) {
    const std::size_t node = plan.texts[i];
    const bool has = node != JsonPaths::kNone && paths.has(node);
    plan.table.text[i].push_back(has ? paths.leaf(node).text : "");
    if (has) any = plan.seen[plan.fields.size() + i] = true;
  }
  if (!any) {
    for (std::vector<double>& column : plan.table.values) column.pop_back();
    for (std::vector<std::string>& column : plan.table.text) column.pop_back();
    ++plan.no_value;
    return;
  }
  std::vector<std::int64_t>& times = plan.table.time_ns;
  if (!times.empty() && *stamp < times.back())
    fail(line, fmt::format("time goes back by {:.3f} s", static_cast<double>(times.back() - *stamp) * 1e-9));
  times.push_back(*stamp);
}

// What was asked for and never came: says what there is instead.
void JsonLinesLog::require_seen(const LinePlan& plan, const Stop& stop) const {
  std::string missing;
  const std::size_t count = plan.fields.size();
  for (std::size_t i = 0; i < plan.seen.size() && missing.empty(); ++i)
    if (!plan.seen[i]) missing = i < count ? plan.request->fields[i] : plan.request->text[i - count];
  if (plan.topic_seen && missing.empty() && !plan.table.time_ns.empty()) return;
  std::vector<std::string> names, fields;
  for (const LogSource& source : sources(stop)) {
    names.push_back(source.name);
    if (source.name != plan.request->source) continue;
    for (const LogField& field : source.fields) fields.push_back(field.path);
  }
  if (!plan.topic_seen) refuse_unknown("source", plan.request->source, shown_path(file_), names);
  const std::string& place = plan.request->source.empty() ? shown_path(file_) : shown(plan.request->source);
  const bool no_time = plan.table.time_ns.empty() && plan.no_value == 0;
  refuse_unknown("field", no_time ? plan.time_path : missing, place, fields);
}

std::vector<LogTable> JsonLinesLog::read(const std::vector<LogRequest>& requests, const Stop& stop) const {
  JsonPaths paths(false);
  const std::size_t topic = paths.add("topic", true);
  std::vector<LinePlan> plans;
  for (const LogRequest& request : requests) plans.push_back(plan(request, paths, stop));
  std::int64_t kept = 0;
  const std::string cut = for_lines(paths, stop, [&](const JsonPaths&, std::size_t line) {
    const bool named = paths.has(topic) && paths.leaf(topic).kind == JsonLeaf::Kind::Text;
    for (LinePlan& plan : plans) {
      if (plan.request->source != (named ? std::string_view(paths.leaf(topic).text) : std::string_view()))
        continue;
      take_line(plan, paths, line);
      if ((kept += 1 + static_cast<std::int64_t>(plan.seen.size())) > kMostValues)
        refuse_too_many_values(shown_path(file_));
    }
    return true;
  });
  std::vector<LogTable> tables;
  for (LinePlan& plan : plans) {
    require_seen(plan, stop);
    std::vector<std::string>& notes = plan.table.notes;
    if (request_was_silent(*plan.request))
      notes.push_back(fmt::format("time: field '{}' taken as {}", plan.time_path, plan.unit.text()));
    if (plan.no_time > 0) notes.push_back(counted(plan.no_time, "line") + " without a time passed over");
    if (plan.no_value > 0)
      notes.push_back(counted(plan.no_value, "line") + " without any of these values passed over");
    if (!cut.empty()) notes.push_back(cut);
    tables.push_back(std::move(plan.table));
  }
  return tables;
}

bool is_json_lines(const fs::path&, const std::string& head) {
  std::string_view text = head;
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos || text[begin] != '{') return false;
  text.remove_prefix(begin);
  const std::size_t end = text.find('\n');
  const std::string_view line = without_blanks(text.substr(0, end));
  const std::size_t last = line.find_last_not_of('\r');
  return end == std::string_view::npos || (last != std::string_view::npos && last > 0 && line[last] == '}');
}

}  // namespace

LogFormat json_lines_log_format() {
  return {"JSON lines", is_json_lines, [](const fs::path& file, const LogOptions& options) {
            return std::unique_ptr<LogFile>(std::make_unique<JsonLinesLog>(file, options.keep_cut));
          }};
}

}  // namespace odobench
