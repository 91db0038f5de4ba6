// The topics of a recording: what they have, when, and why they cannot be read.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include "datasets/logs/ros/messages/json_message.hpp"
#include "datasets/logs/ros/messages/message_reader.hpp"
#include "datasets/logs/ros/messages/message_survey.hpp"
#include "datasets/logs/ros/ros_log.hpp"

namespace odobench {
namespace {

constexpr std::size_t kMostDelays = 65536;

// Every n-th difference, so that memory stays bounded whatever the log's length.
class Delays {
 public:
  void add(std::int64_t ns) {
    if (count_++ % every_ != 0) return;
    values_.push_back(ns);
    if (values_.size() < kMostDelays) return;
    for (std::size_t i = 0; 2 * i < values_.size(); ++i) values_[i] = values_[2 * i];
    values_.resize(values_.size() / 2);
    every_ *= 2;
  }
  std::optional<std::int64_t> median() {
    if (values_.empty()) return std::nullopt;
    const auto middle = values_.begin() + static_cast<std::ptrdiff_t>(values_.size() / 2);
    std::nth_element(values_.begin(), middle, values_.end());
    return *middle;
  }

 private:
  std::vector<std::int64_t> values_;
  std::int64_t count_ = 0, every_ = 1;
};

class SurveySink : public RosSink {
 public:
  explicit SurveySink(const LogOptions& options) : types_(options) {}

  int channel(const RosChannel& channel) override {
    const auto [number, fresh] = numbers_.number(channel);
    if (!fresh) return number;
    const auto [topic, first] = topic_of_.emplace(channel.topic, topics_.size());
    if (first) {
      topics_.emplace_back().source.name = channel.topic;
      topics_.back().source.type = short_type_name(channel.type);
    }
    Channel c;
    c.topic = topic->second;
    c.json = channel.encoding == RosEncoding::Json;
    LogSource& source = topics_[c.topic].source;
    try {
      source.unreadable = channel.unreadable;
      if (source.unreadable.empty() && !c.json) types_.of(channel);
    } catch (const BadDefinition& e) {
      source.unreadable = e.what();
    }
    c.channel = channel;
    channels_.push_back(std::move(c));
    return number;
  }

  void message(int channel, std::int64_t log_ns, std::string_view bytes, const MessagePlace&) override {
    Channel& c = channels_[static_cast<std::size_t>(channel)];
    Topic& topic = topics_[c.topic];
    LogSource& source = topic.source;
    if (source.rows++ == 0) {
      source.first_ns = log_ns;
    } else if (log_ns > source.last_ns) {
      // A gap beyond 292 years is as good as endless.
      std::int64_t gap = 0;
      if (__builtin_sub_overflow(log_ns, source.last_ns, &gap))
        gap = std::numeric_limits<std::int64_t>::max();
      source.largest_gap_ns = std::max(source.largest_gap_ns, gap);
    }
    source.last_ns = log_ns;
    if (!source.unreadable.empty()) return;
    try {
      look(c, topic, log_ns, bytes);
    } catch (const BadMessage& e) {
      source.unreadable = fmt::format("a message does not fit {}: {}", source.type, e.what());
    } catch (const BadDefinition& e) {
      source.unreadable = e.what();
    }
  }

  std::vector<LogSource> sources() {
    std::vector<LogSource> all;
    for (Channel& c : channels_) {
      if (c.survey == nullptr) continue;
      auto& fields = topics_[c.topic].source.fields;
      for (const LogField& f : c.survey->fields())
        if (topics_[c.topic].paths.insert(f.path).second) fields.push_back(f);
    }
    for (Topic& topic : topics_) {
      topic.source.stamp_minus_log_ns = topic.delays.median();
      all.push_back(std::move(topic.source));
    }
    return all;
  }

 private:
  struct Topic {
    LogSource source;
    Delays delays;
    std::unordered_set<std::string> paths;
  };
  struct Channel {
    RosChannel channel;
    std::size_t topic = 0;
    bool json = false, json_listed = false;
    std::unique_ptr<MessageSurvey> survey;
    std::unique_ptr<RowReader> stamps;
  };

  // What reads a channel is made when it has a message: files may have many channels and few messages.
  void prepare(Channel& c) {
    if (c.stamps != nullptr) return;
    if (c.json) {
      c.stamps = json_reader({});
      return;
    }
    const std::shared_ptr<const RosTypes> types = types_.of(c.channel);
    c.survey = std::make_unique<MessageSurvey>(types, c.channel.encoding);
    c.stamps = std::make_unique<MessageReader>(types, c.channel.encoding, MessageRequest{});
  }

  void look(Channel& c, Topic& topic, std::int64_t log_ns, std::string_view bytes) {
    prepare(c);
    if (c.survey != nullptr) c.survey->add(bytes);
    if (c.json && !c.json_listed) {
      topic.source.fields = json_fields(bytes);
      c.json_listed = true;
    }
    const RowReader::Rows rows = c.stamps->read(bytes);
    std::int64_t delay = 0;
    if (rows.count > 0 && rows.begin->has_time && rows.begin->time != 0 &&
        c.stamps->time_primitive() == RosPrimitive::Time &&
        !__builtin_sub_overflow(rows.begin->time, log_ns, &delay))
      topic.delays.add(delay);
  }

  ChannelTypes types_;
  ChannelNumbers numbers_;
  std::vector<Channel> channels_;
  std::vector<Topic> topics_;
  std::unordered_map<std::string, std::size_t> topic_of_;
};

}  // namespace

std::vector<LogSource> survey_recording(const RosContainers& files, const LogOptions& options,
                                        const Stop& stop) {
  SurveySink sink(options);
  walk_recording(files, sink, options, stop);
  return sink.sources();
}

}  // namespace odobench
