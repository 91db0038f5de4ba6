// Messages that are JSON texts, as MCAP files may hold them: the same paths as in other messages.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/logs/log_file.hpp"
#include "datasets/logs/ros/messages/message_reader.hpp"

namespace odobench {

// Rows as MessageReader gives them; of an array's elements that a path selects the first. A stamp is a number
// or an object with sec and nsec (nanosec, secs, nsecs). Without a path the time is that of header.stamp or
// timestamp, where it is an object.
std::unique_ptr<RowReader> json_reader(MessageRequest request);

// What the message has, by paths: numbers, booleans and texts. Throws BadMessage.
std::vector<LogField> json_fields(std::string_view message);

}  // namespace odobench
