// What stands in JSON lines: topics, their fields, and which field tells their time.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/logs/log_file.hpp"
#include "datasets/logs/log_names.hpp"
#include "datasets/logs/log_time.hpp"
#include "datasets/logs/tables/json_paths.hpp"

namespace odobench {

// The stamp in this leaf; nothing where it is none in this unit.
std::optional<std::int64_t> stamp_of(const JsonLeaf& leaf, const TimeUnit& unit);

// A request that leaves it to the reader what tells time, or in which unit.
inline bool request_was_silent(const LogRequest& request) {
  return request.time.empty() || request.time_unit.empty();
}

// Looks at lines one after the other: paths().parse(), then take_line().
class JsonTopics {
 public:
  explicit JsonTopics(std::filesystem::path file) : file_(std::move(file)) {}

  JsonPaths& paths() { return paths_; }
  void take_line();
  // Enough lines of this topic were seen to know its time.
  bool decided(const std::string& topic) const;
  // The path of the field that tells time (unless given) and its unit (unless given). std::invalid_argument
  // where they cannot be found, or there is no such topic.
  void find_time(const std::string& topic, std::string& path, std::string& unit);
  std::vector<LogSource> sources();

 private:
  struct Field {
    std::size_t node;
    LogField info;
    std::vector<std::string> samples;
  };
  struct Topic {
    std::vector<Field> fields;
    std::map<std::size_t, std::size_t> place;  // of a node among the fields
    std::int64_t rows = 0;
    bool decided = false;
    std::size_t time = JsonPaths::kNone;  // node
    std::string unit;
    RowTimes stamps;
  };

  void take_sample(Topic& topic, std::size_t node);
  void decide(Topic& topic);
  Topic& topic_of_line();

  std::filesystem::path file_;
  JsonPaths paths_{true};
  std::map<std::string, std::size_t> place_;
  std::vector<std::pair<std::string, Topic>> topics_;
  std::size_t fields_ = 0;
  std::size_t topic_node_ = paths_.add("topic", true);
};

}  // namespace odobench
