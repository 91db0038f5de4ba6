// Tables of what is asked for, out of all files of a recording.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "base/files.hpp"
#include "base/names.hpp"
#include "base/text.hpp"
#include "datasets/logs/log_time.hpp"
#include "datasets/logs/ros/messages/json_message.hpp"
#include "datasets/logs/ros/messages/message_path.hpp"
#include "datasets/logs/ros/messages/message_reader.hpp"
#include "datasets/logs/ros/ros_log.hpp"

namespace odobench {
namespace {

constexpr std::size_t kMostKeptValues = 100'000'000;

// Nanoseconds of one unit of a time that is a plain number; of integers without a unit by their size.
std::int64_t nanoseconds_of_unit(const std::string& unit, double example) {
  if (unit == "ns") return 1;
  if (unit == "us") return 1'000;
  if (unit == "ms") return 1'000'000;
  if (unit == "s") return 1'000'000'000;
  // Times since 1970 are 1.7e9 s now.
  const double size = std::abs(example);
  return size > 1e17 ? 1 : size > 1e14 ? 1'000 : size > 1e11 ? 1'000'000 : 1'000'000'000;
}

// A time that is text, as the unit says: ISO 8601 or a pattern.
bool is_text(const std::string& unit) {
  return !unit.empty() && unit != "s" && unit != "ms" && unit != "us" && unit != "ns";
}

std::int64_t to_nanoseconds(const MessageRow& row, RosPrimitive primitive, std::int64_t unit) {
  constexpr double kMost = 9.2e18;
  if (primitive == RosPrimitive::Float32 || primitive == RosPrimitive::Float64) {
    const double ns = row.time_real * static_cast<double>(unit);
    return std::isfinite(ns) && std::abs(ns) < kMost ? std::llround(ns) : 0;
  }
  return std::abs(static_cast<double>(row.time)) * static_cast<double>(unit) < kMost ? row.time * unit : 0;
}

// "odom,base" of "transforms[header.frame_id=odom,child_frame_id=base]".
std::string values_of(const PathStep& step) {
  std::string values;
  for (const PathStep::Selector& selector : step.selectors)
    values += (values.empty() ? "" : ",") + selector.value;
  return values;
}

class ReadSink : public RosSink {
 public:
  ReadSink(const std::vector<LogRequest>& requests, const LogOptions& options)
      : options_(options), types_(options), states_(requests.size()) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      State& s = states_[i];
      s.request = &requests[i];
      s.table.values.resize(requests[i].fields.size());
      s.table.text.resize(requests[i].text.size());
      s.found.assign(requests[i].fields.size(), false);
      if (!requests[i].time_unit.empty()) {
        TimeUnit unit(requests[i].time_unit);
        if (is_text(requests[i].time_unit) && !requests[i].time.empty()) s.text_time = std::move(unit);
      }
      topics_.insert(requests[i].source);
    }
  }

  int channel(const RosChannel& channel) override;
  void message(int channel, std::int64_t log_ns, std::string_view bytes, const MessagePlace& place) override;
  void set_files(const RosContainers& files) { files_ = &files; }
  std::vector<LogTable> tables(const Stop& stop);

 private:
  struct State {
    const LogRequest* request = nullptr;
    LogTable table;
    std::int64_t messages = 0, without_values = 0, without_stamp = 0, zero_stamp = 0;
    std::int64_t unit = 0;              // of a time that is a plain number; 0: not yet known
    std::optional<TimeUnit> text_time;  // of one that is text, which is then the last text of a row
    bool known = false;                 // its source is there
    bool json = false;
    std::string type;
    std::vector<bool> found;  // by field
  };
  struct Reader {
    std::size_t state;
    std::unique_ptr<RowReader> reader;
  };
  struct Channel {
    std::string topic;
    std::vector<Reader> readers;
  };

  void add_reader(const RosChannel& channel, std::size_t state, Channel& to);
  void append(State& s, const MessageRow& row, const RowReader& reader, std::int64_t log_ns);
  std::int64_t time_of(State& s, const MessageRow& row, const RowReader& reader, std::int64_t log_ns);
  void refuse_unknown_source(const State& s) const;
  std::vector<std::string> paths_in(const State& s, const Stop& stop) const;
  void refuse_unfound(const State& s, const Stop& stop) const;
  [[noreturn]] void refuse_name(const State& s, const std::vector<PathStep>& steps, std::size_t at,
                                const Stop& stop) const;
  void add_notes(State& s) const;

  const LogOptions& options_;
  const RosContainers* files_ = nullptr;
  ChannelTypes types_;
  ChannelNumbers numbers_;
  std::vector<Channel> channels_;
  std::vector<State> states_;
  std::set<std::string> topics_;  // wanted ones
  std::vector<std::string> seen_topics_;
  std::size_t kept_ = 0;
};

int ReadSink::channel(const RosChannel& channel) {
  if (std::find(seen_topics_.begin(), seen_topics_.end(), channel.topic) == seen_topics_.end())
    seen_topics_.push_back(channel.topic);
  if (topics_.count(channel.topic) == 0) return -1;
  const auto [number, fresh] = numbers_.number(channel);
  if (!fresh) return number;
  channels_.emplace_back().topic = channel.topic;
  for (std::size_t i = 0; i < states_.size(); ++i)
    if (states_[i].request->source == channel.topic) add_reader(channel, i, channels_.back());
  return number;
}

void ReadSink::add_reader(const RosChannel& channel, std::size_t state, Channel& to) {
  State& s = states_[state];
  s.known = true;
  if (s.type.empty()) s.type = short_type_name(channel.type);
  s.json = channel.encoding == RosEncoding::Json;
  std::string unreadable = channel.unreadable;
  MessageRequest request{s.request->fields, s.request->text, s.request->time};
  if (s.text_time) {
    request.text.push_back(request.time);
    request.time.clear();
  }
  try {
    if (unreadable.empty() && channel.encoding == RosEncoding::Json) {
      to.readers.push_back({state, json_reader(request)});
    } else if (unreadable.empty()) {
      to.readers.push_back(
          {state, std::make_unique<MessageReader>(types_.of(channel), channel.encoding, request)});
    }
  } catch (const BadDefinition& e) {
    unreadable = e.what();
  }
  if (!unreadable.empty())
    throw DataError(fmt::format("{}: topic {}: {}", shown_path(files_->front()->file()), shown(channel.topic),
                                unreadable));
}

void ReadSink::message(int channel, std::int64_t log_ns, std::string_view bytes, const MessagePlace& place) {
  for (Reader& reader : channels_[static_cast<std::size_t>(channel)].readers) {
    State& s = states_[reader.state];
    try {
      const RowReader::Rows rows = reader.reader->read(bytes);
      ++s.messages;
      for (std::size_t i = 0; i < rows.count; ++i) append(s, rows.begin[i], *reader.reader, log_ns);
      for (std::size_t i = 0; i < s.found.size(); ++i)
        if (!s.found[i]) s.found[i] = reader.reader->found()[i];
    } catch (const BadMessage& e) {
      throw DataError(
          at_message(place, s.request->source, fmt::format("does not fit {}: {}", shown(s.type), e.what())));
    } catch (const BadDefinition& e) {
      throw DataError(at_message(place, s.request->source, e.what()));
    }
  }
}

std::int64_t ReadSink::time_of(State& s, const MessageRow& row, const RowReader& reader,
                               std::int64_t log_ns) {
  if (s.text_time) {
    const std::string_view text = row.text.back();
    if (const std::optional<std::int64_t> ns = s.text_time->of(text)) return *ns;
    throw DataError(fmt::format("{}: topic {}: {}: found \"{}\", expected {}",
                                shown_path(files_->front()->file()), shown(s.request->source),
                                shown(s.request->time), shown(std::string(text)), s.text_time->text()));
  }
  if (!row.has_time) {
    ++s.without_stamp;
    return log_ns;
  }
  std::int64_t ns = row.time;
  const RosPrimitive primitive = reader.time_primitive();
  if (primitive != RosPrimitive::Time) {
    const bool real = primitive == RosPrimitive::Float32 || primitive == RosPrimitive::Float64;
    if (s.unit == 0)
      s.unit =
          nanoseconds_of_unit(s.request->time_unit, real ? row.time_real : static_cast<double>(row.time));
    ns = to_nanoseconds(row, primitive, s.unit);
  }
  if (ns != 0 || primitive != RosPrimitive::Time) return ns;
  ++s.zero_stamp;
  return log_ns;
}

void ReadSink::append(State& s, const MessageRow& row, const RowReader& reader, std::int64_t log_ns) {
  const std::size_t columns = row.numbers.size() + row.text.size();
  if (columns > 0 && row.present == 0) {
    ++s.without_values;
    return;
  }
  kept_ += columns + 2;
  for (const std::string_view text : row.text) kept_ += text.size() / sizeof(double);
  if (kept_ > kMostKeptValues)
    throw DataError(fmt::format("{}: topic {}: more than {} values are asked for",
                                shown_path(files_->front()->file()), shown(s.request->source),
                                kMostKeptValues));
  s.table.time_ns.push_back(time_of(s, row, reader, log_ns));
  s.table.log_time_ns.push_back(log_ns);
  for (std::size_t i = 0; i < row.numbers.size(); ++i) s.table.values[i].push_back(row.numbers[i]);
  for (std::size_t i = 0; i < s.table.text.size(); ++i) s.table.text[i].emplace_back(row.text[i]);
}

void ReadSink::refuse_unknown_source(const State& s) const {
  throw std::invalid_argument(fmt::format("no topic '{}' in {}{}; it has {}", shown(s.request->source),
                                          shown_path(files_->front()->file()),
                                          did_you_mean(s.request->source, seen_topics_),
                                          shown(fmt::format("{}", fmt::join(seen_topics_, ", ")), 1000)));
}

// The fields of a source as they come up in its messages.
std::vector<std::string> ReadSink::paths_in(const State& s, const Stop& stop) const {
  std::vector<std::string> paths;
  for (const LogSource& source : survey_recording(*files_, options_, stop))
    if (source.name == s.request->source)
      for (const LogField& field : source.fields) paths.push_back(field.path);
  return paths;
}

// Fields that no message has: names and elements that are looked for, and all of JSON.
void ReadSink::refuse_unfound(const State& s, const Stop& stop) const {
  for (std::size_t i = 0; i < s.found.size(); ++i) {
    if (s.found[i] || s.messages == 0) continue;
    const std::string& path = s.request->fields[i];
    const std::vector<PathStep> steps = parse_message_path(path);
    const auto step =
        std::find_if(steps.begin(), steps.end(), [](const PathStep& p) { return !p.selectors.empty(); });
    if (step != steps.end()) refuse_name(s, steps, static_cast<std::size_t>(step - steps.begin()), stop);
    if (!s.json) continue;
    const std::vector<std::string> known = paths_in(s, stop);
    throw std::invalid_argument(
        fmt::format("no field '{}' in {}{} it has {}", shown(path), shown(s.type),
                    did_you_mean(path, known) + (did_you_mean(path, known).empty() ? ":" : ""),
                    shown(fmt::format("{}", fmt::join(known, ", ")), 1000)));
  }
}

// "no joint 'left_wheel' in 600 messages; joints: caster_joint, left_wheel_joint".
void ReadSink::refuse_name(const State& s, const std::vector<PathStep>& steps, std::size_t at,
                           const Stop& stop) const {
  const PathStep& step = steps[at];
  std::string prefix;
  for (std::size_t i = 0; i < at; ++i) prefix += path_step_text(steps[i]) + ".";
  prefix += step.name + "[";
  std::set<std::string> names;  // what there is
  for (const std::string& path : paths_in(s, stop))
    if (path.compare(0, prefix.size(), prefix) == 0) {
      const auto parts = parse_message_path(path);
      if (at < parts.size() && !parts[at].selectors.empty()) names.insert(values_of(parts[at]));
    }
  const std::string word = s.type == "sensor_msgs/JointState" ? "joint"
                           : step.selectors.size() > 1        ? "element"
                                                              : step.selectors[0].key;
  throw DataError(fmt::format("{}: topic {}: no {} '{}' in {} messages; {}s: {}",
                              shown_path(files_->front()->file()), shown(s.request->source), shown(word),
                              shown(values_of(step)), s.messages, shown(word),
                              shown(fmt::format("{}", fmt::join(names, ", ")), 1000)));
}

void ReadSink::add_notes(State& s) const {
  const std::string topic = shown(s.request->source);
  if (s.without_stamp > 0)
    s.table.notes.push_back(fmt::format("topic {}: {} of {} rows have no stamp: their time is the log's",
                                        topic, s.without_stamp, s.table.time_ns.size()));
  if (s.zero_stamp > 0)
    s.table.notes.push_back(fmt::format("topic {}: {} of {} rows have stamp 0: their time is the log's",
                                        topic, s.zero_stamp, s.table.time_ns.size()));
  if (s.without_values > 0)
    s.table.notes.push_back(
        fmt::format("topic {}: {} messages have none of the fields: left out", topic, s.without_values));
  s.table.notes.insert(s.table.notes.end(), notes.begin(), notes.end());
}

std::vector<LogTable> ReadSink::tables(const Stop& stop) {
  std::vector<LogTable> tables;
  for (State& s : states_) {
    if (!s.known) refuse_unknown_source(s);
    refuse_unfound(s, stop);
    add_notes(s);
    tables.push_back(std::move(s.table));
  }
  return tables;
}

}  // namespace

std::vector<LogTable> read_recording(const RosContainers& files, const std::vector<LogRequest>& requests,
                                     const LogOptions& options, const Stop& stop) {
  ReadSink sink(requests, options);
  sink.set_files(files);
  walk_recording(files, sink, options, stop);
  return sink.tables(stop);
}

}  // namespace odobench
