// One recording of ROS messages, of one file or several, as tables.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "datasets/logs/ros/containers.hpp"
#include "datasets/logs/ros/messages/message_definition.hpp"

namespace odobench {

using RosContainers = std::vector<std::unique_ptr<RosContainer>>;

// Lets the sink see all files. What is cut off is a DataError, or with `keep_cut` a note.
void walk_recording(const RosContainers& files, RosSink& sink, const LogOptions& options, const Stop& stop);

// "FILE: byte N: topic T: WHAT", in tables "FILE: message N: topic T: WHAT".
std::string at_message(const MessagePlace& place, const std::string& topic, const std::string& what);

// Numbers of channels: the same for what is the same in several files, or in several connections of one.
class ChannelNumbers {
 public:
  // The number of this channel, and whether it is new: then it is the next one. Throws DataError when there
  // are too many.
  std::pair<int, bool> number(const RosChannel& channel);

 private:
  // Of a definition its hash: many channels may share a long one.
  std::map<std::tuple<std::string, std::string, RosEncoding, std::size_t>, int> known_;
};

// parse_message_definition() of channels, of which many may share a definition.
class ChannelTypes {
 public:
  explicit ChannelTypes(const LogOptions& options) : options_(options) {}
  std::shared_ptr<const RosTypes> of(const RosChannel& channel);  // throws BadDefinition

 private:
  struct Entry {
    std::shared_ptr<const std::string> definition;
    std::string type;
    RosEncoding encoding;
    std::shared_ptr<const RosTypes> types;
  };
  const LogOptions& options_;
  std::vector<Entry> recent_;
};

// LogFile::sources() and LogFile::read() of the files of a recording.
std::vector<LogSource> survey_recording(const RosContainers& files, const LogOptions& options,
                                        const Stop& stop);
std::vector<LogTable> read_recording(const RosContainers& files, const std::vector<LogRequest>& requests,
                                     const LogOptions& options, const Stop& stop);

}  // namespace odobench
