// Values out of serialised messages of one type: ROS 1, CDR (XCDR1, and XCDR2 of what is serialised alike but
// for the alignment).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/logs/ros/messages/message_plan.hpp"
#include "datasets/logs/ros/messages/message_wire.hpp"

namespace odobench {

// One row: a message, or an element of an array that was selected.
struct MessageRow {
  std::vector<double> numbers;         // NaN where there is none
  std::vector<std::string_view> text;  // into the message
  std::size_t present = 0;             // values that were there, the time left out
  bool has_time = false;
  std::int64_t time = 0;  // stamps in nanoseconds; integers as they are
  double time_real = 0;   // of floating-point numbers
};

// Reads rows out of the messages of one channel.
class RowReader {
 public:
  virtual ~RowReader() = default;
  // The rows of a message, valid until the next call and as long as its bytes. Throws BadMessage.
  struct Rows {
    const MessageRow* begin;
    std::size_t count;
  };
  virtual Rows read(std::string_view message) = 0;
  virtual bool has_time_path() const = 0;
  virtual RosPrimitive time_primitive() const = 0;
  // By place in the request's numbers: whether a name or element that its path asks for was found so far.
  virtual const std::vector<bool>& found() const = 0;
};

class MessageReader : public RowReader {
 public:
  // An empty time is that of default_time_path(). Throws what plan_message() throws.
  MessageReader(std::shared_ptr<const RosTypes> types, RosEncoding encoding, MessageRequest request);
  ~MessageReader() override;

  Rows read(std::string_view message) override;
  bool has_time_path() const override;
  RosPrimitive time_primitive() const override;
  const std::vector<bool>& found() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace odobench
