#include <fmt/format.h>

#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/logs/ros/log_input.hpp"
#include "datasets/logs/ros/ros_log.hpp"

namespace odobench {
namespace {

// 2913 as "2,913".
std::string grouped_digits(std::int64_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
  return digits;
}

}  // namespace

void walk_recording(const RosContainers& files, RosSink& sink, const LogOptions& options, const Stop& stop) {
  for (const auto& file : files) {
    try {
      file->walk(sink, stop);
    } catch (const LogCutOff& cut) {
      const std::string what = cut.expected > 0
                                   ? fmt::format("{} bytes expected, {} left", cut.expected, cut.left)
                                   : fmt::format("a chunk that was not ended, {} bytes left", cut.left);
      if (!options.keep_cut)
        fail_at(cut.file, cut.byte,
                fmt::format("{}: the {} is cut off (--keep-cut imports the {} messages before)", what,
                            file->format() == std::string_view("MCAP") ? "file" : "bag",
                            grouped_digits(sink.seen)));
      sink.notes.push_back(fmt::format("{}: byte {}: {}: cut off; the {} messages before are kept",
                                       shown_path(cut.file), cut.byte, what, grouped_digits(sink.seen)));
    }
  }
}

std::string at_message(const MessagePlace& place, const std::string& topic, const std::string& what) {
  return fmt::format("{}: {} {}: topic {}: {}", shown_path(*place.file), place.row ? "message" : "byte",
                     place.number, shown(topic), what);
}

std::pair<int, bool> ChannelNumbers::number(const RosChannel& channel) {
  const auto [entry, fresh] = known_.emplace(
      std::tuple(channel.topic, channel.type, channel.encoding,
                 channel.definition == nullptr ? 0 : std::hash<std::string>{}(*channel.definition)),
      static_cast<int>(known_.size()));
  if (known_.size() > kMostLogChannels)
    throw DataError(fmt::format("topic {}: more than {} topics", shown(channel.topic), kMostLogChannels));
  return {entry->second, fresh};
}

std::shared_ptr<const RosTypes> ChannelTypes::of(const RosChannel& channel) {
  constexpr std::size_t kMostRecent = 64;
  for (const Entry& e : recent_)
    if (e.definition == channel.definition && e.type == channel.type && e.encoding == channel.encoding)
      return e.types;
  auto types = std::make_shared<const RosTypes>(
      parse_message_definition(channel.type, channel.definition.get(), channel.encoding, options_.messages));
  if (recent_.size() >= kMostRecent) recent_.erase(recent_.begin());
  recent_.push_back({channel.definition, channel.type, channel.encoding, types});
  return types;
}

}  // namespace odobench
