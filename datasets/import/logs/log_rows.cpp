#include "datasets/import/logs/log_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>

#include "base/error.hpp"
#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/logs/formats.hpp"

namespace odobench::log_import {
namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kMostDisorder = 1'000'000'000;    // ns
constexpr std::int64_t kLatest = std::int64_t{1} << 62;  // ns, so that differences of two are numbers
constexpr std::array<char, 4> kQuaternion = {'x', 'y', 'z', 'w'};

// "pose.orientation.x" of messages, "qx" of tables, whose columns are called by one word.
std::string quaternion_part(const std::string& path, char part) {
  return path + (path.back() == 'q' ? "" : ".") + part;
}

std::vector<const MappedField*> fields_of(const LogMap& map, const std::string& source) {
  std::vector<const MappedField*> all;
  for (const MappedField& field : map.reference) all.push_back(&field);
  for (const MappedSignal& signal : map.signals) all.push_back(&signal.at);
  for (const MappedField& field : map.others) all.push_back(&field);
  std::erase_if(all, [&](const MappedField* f) { return f->source != source; });
  return all;
}

std::vector<std::string> paths_of(const MappedField& field) {
  if (field.quaternion.empty()) return {field.field};
  std::vector<std::string> paths;
  for (const char part : kQuaternion) paths.push_back(quaternion_part(field.quaternion, part));
  return paths;
}

LogRequest request_of(const LogMap& map, const MappedSource& source, const std::set<std::string>& without) {
  LogRequest request{source.topic, source.time, source.time_unit, {}, {}};
  for (const MappedField* field : fields_of(map, source.name))
    for (const std::string& path : paths_of(*field))
      if (!without.contains(path) &&
          std::find(request.fields.begin(), request.fields.end(), path) == request.fields.end())
        request.fields.push_back(path);
  return request;
}

// The field that a refusal is about: the one that its message quotes.
const MappedField* culprit(const LogMap& map, const std::vector<const MappedSource*>& sources,
                           const std::string& message) {
  for (const MappedSource* source : sources)
    for (const MappedField* field : fields_of(map, source->name))
      for (const std::string& path : paths_of(*field))
        if (message.find('\'' + shown(path) + '\'') != std::string::npos) return field;
  return nullptr;
}

struct Answer {
  std::vector<LogRequest> requests;
  std::vector<LogTable> tables;  // one per request
};

// The tables of these sources in one file, without optional fields that it has not.
Answer read_file_of(const LogMap& map, const fs::path& file, const std::vector<const MappedSource*>& sources,
                    LogOptions options, const Stop& stop, std::vector<std::string>& notes) {
  for (const MappedSource* source : sources) {
    const LogOptions& own = source->format;
    if (!own.separator.empty()) options.separator = own.separator;
    if (!own.decimal.empty()) options.decimal = own.decimal;
    if (!own.comment.empty()) options.comment = own.comment;
    if (!own.encoding.empty()) options.encoding = own.encoding;
    if (own.header_rows) options.header_rows = own.header_rows;
  }
  const std::unique_ptr<LogFile> log = open_log(file, options);
  std::set<std::string> without;
  for (;;) {
    Answer answer;
    for (const MappedSource* source : sources) answer.requests.push_back(request_of(map, *source, without));
    try {
      answer.tables = log->read(answer.requests, stop);
      return answer;
    } catch (const std::invalid_argument& error) {
      const MappedField* field = culprit(map, sources, error.what());
      if (field != nullptr && field->optional && without.insert(paths_of(*field).front()).second) {
        for (const std::string& path : paths_of(*field)) without.insert(path);
        notes.push_back(
            fmt::format("{} has no {} for {}", shown_path(file), shown(field->field), field->target));
        continue;
      }
      throw DataError(field == nullptr
                          ? fmt::format("{}: {}", shown_path(file), error.what())
                          : fmt::format("{}: /signals/{}/{}: {}: {}", map.file, shown(field->target),
                                        field->quaternion.empty() ? "field" : "quaternion", shown_path(file),
                                        error.what()));
    }
  }
}

[[noreturn]] void refuse_stamp(std::int64_t stamp, const fs::path& file) {
  throw DataError(
      fmt::format("{}: a stamp of {} ns, expected times within 146 years of 1970", shown_path(file), stamp));
}

// Whatever stamps a log has.
std::int64_t lessened(std::int64_t stamp, std::int64_t by, const fs::path& file) {
  std::int64_t difference = 0;
  if (__builtin_sub_overflow(stamp, by, &difference)) refuse_stamp(stamp, file);
  return difference;
}

struct Order {
  std::vector<std::size_t> rows;  // in the order of time, each stamp once
  std::size_t repeated = 0, moved = 0;
};

Order order_of(const std::vector<std::int64_t>& time, const fs::path& file) {
  Order order;
  order.rows.resize(time.size());
  std::iota(order.rows.begin(), order.rows.end(), std::size_t{0});
  std::int64_t latest = std::numeric_limits<std::int64_t>::min();
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (k > 0 && time[k] < latest) {
      if (const std::int64_t back = lessened(latest, time[k], file); back > kMostDisorder)
        throw DataError(fmt::format("{}: row {}: time goes back by {:.3f} s", shown_path(file), k + 1,
                                    static_cast<double>(back) * 1e-9));
      ++order.moved;
    }
    latest = std::max(latest, time[k]);
  }
  if (order.moved > 0)
    std::stable_sort(order.rows.begin(), order.rows.end(),
                     [&](std::size_t a, std::size_t b) { return time[a] < time[b]; });
  const auto end = std::unique(order.rows.begin(), order.rows.end(),
                               [&](std::size_t a, std::size_t b) { return time[a] == time[b]; });
  order.repeated = static_cast<std::size_t>(order.rows.end() - end);
  order.rows.erase(end, order.rows.end());
  return order;
}

void measure_delay(const LogTable& table, SourceRows& rows) {
  if (table.log_time_ns.size() != table.time_ns.size() || table.time_ns.empty()) return;
  std::vector<double> delay(table.time_ns.size());
  for (std::size_t k = 0; k < delay.size(); ++k)
    delay[k] = (static_cast<double>(table.time_ns[k]) - static_cast<double>(table.log_time_ns[k])) * 1e-9;
  const auto at_share = [&](double share) {
    const auto nth =
        delay.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(delay.size() - 1));
    std::nth_element(delay.begin(), nth, delay.end());
    return *nth;
  };
  const double median = at_share(0.5);
  for (double& d : delay) d = std::abs(d - median);
  rows.delay_median_s = median;
  rows.delay_99_s = at_share(0.99);
}

SourceRows rows_of(const LogTable& table, const LogRequest& request, const MappedSource& source,
                   const fs::path& file, std::vector<std::string>& notes) {
  SourceRows rows;
  const Order order = order_of(table.time_ns, file);
  for (const auto& [count, what] : {std::pair{order.repeated, "repeat a stamp: left out"},
                                    std::pair{order.moved, "were out of order: sorted"}})
    if (count > 0)
      notes.push_back(
          fmt::format("{}: {} rows of {} {}", file.filename().string(), count, source.name, what));
  for (const std::string& text : table.notes)
    if (const std::string line = file.filename().string() + ": " + text;
        std::find(notes.begin(), notes.end(), line) == notes.end())
      notes.push_back(line);
  rows.time_ns.reserve(order.rows.size());
  for (const std::size_t k : order.rows) rows.time_ns.push_back(table.time_ns[k]);
  for (std::size_t f = 0; f < request.fields.size(); ++f) {
    std::vector<double>& values = rows.values[request.fields[f]];
    values.reserve(order.rows.size());
    for (const std::size_t k : order.rows) values.push_back(table.values[f][k]);
  }
  measure_delay(table, rows);
  if (const double offset = source.offset_s.value_or(0); offset != 0)
    for (std::int64_t& t : rows.time_ns) t = lessened(t, std::llround(offset * 1e9), file);
  for (const std::int64_t t : rows.time_ns)
    if (t > kLatest || t < -kLatest) refuse_stamp(t, file);
  return rows;
}

}  // namespace

bool LogRows::has(const MappedField& field) const {
  return rows.contains(field.source) && of(field.source).values.contains(paths_of(field).front());
}

std::vector<double> LogRows::values(const MappedField& field) const {
  const SourceRows& source = of(field.source);
  if (field.quaternion.empty()) return source.values.at(field.field);
  std::array<const std::vector<double>*, 4> q{};
  for (std::size_t i = 0; i < 4; ++i)
    q[i] = &source.values.at(quaternion_part(field.quaternion, kQuaternion[i]));
  std::vector<double> yaw(source.time_ns.size());
  for (std::size_t k = 0; k < yaw.size(); ++k) {
    const double x = (*q[0])[k], y = (*q[1])[k], z = (*q[2])[k], w = (*q[3])[k];
    yaw[k] = std::atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z);
  }
  return yaw;
}

LogRows read_rows(const LogMap& map, const LogGroup& group, const LogOptions& options, const Stop& stop) {
  LogRows out;
  std::map<fs::path, std::vector<const MappedSource*>> by_file;
  for (const MappedSource& source : map.sources)
    if (!fields_of(map, source.name).empty()) by_file[group.file_of.at(source.name)].push_back(&source);
  for (const auto& [file, sources] : by_file) {
    const Answer answer = read_file_of(map, file, sources, options, stop, out.notes);
    for (std::size_t i = 0; i < sources.size(); ++i) {
      out.rows[sources[i]->name] =
          rows_of(answer.tables[i], answer.requests[i], *sources[i], file, out.notes);
      out.files[sources[i]->name] = file;
    }
  }
  return out;
}

}  // namespace odobench::log_import
