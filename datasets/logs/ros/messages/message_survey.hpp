// What stands in the messages of a channel: paths with first values, names and frames as they come up.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "datasets/logs/log_file.hpp"
#include "datasets/logs/ros/messages/message_wire.hpp"

namespace odobench {

class MessageSurvey {
 public:
  MessageSurvey(std::shared_ptr<const RosTypes> types, RosEncoding encoding)
      : types_(std::move(types)), encoding_(encoding) {}

  // Looks at the message when it may have something new: the first ones, those of a size that was not yet
  // seen, and now and then another. Throws BadMessage.
  void add(std::string_view message);
  const std::vector<LogField>& fields() const { return fields_; }

 private:
  using Found = std::vector<LogField>;  // paths relative to the message that has them
  void message(std::size_t type, Found& found, bool list);
  void field(const RosField& f, std::vector<std::string>& names, std::string& names_field, Found& found,
             bool list);
  void numbers(const RosField& f, std::uint64_t count, const std::vector<std::string>& names,
               const std::string& names_field, Found& found, bool list);
  void messages(const RosField& f, std::uint64_t count, Found& found, bool list);
  std::string number_text(RosPrimitive primitive, const char* bytes) const;

  std::shared_ptr<const RosTypes> types_;
  RosEncoding encoding_;
  MessageWire wire_;
  std::vector<LogField> fields_;
  std::unordered_set<std::string> known_;
  std::unordered_set<std::size_t> sizes_;
  std::int64_t messages_ = 0;
};

}  // namespace odobench
