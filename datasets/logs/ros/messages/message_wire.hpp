// The bytes of a serialised message from front to back.
//
// ROS 1 (wiki.ros.org/msg): packed, little-endian, strings by length. CDR (OMG DDSI-RTPS, XCDR1): four bytes
// that tell the order of bytes, then each number at a multiple of its size, counted behind these four;
// strings end with NUL. XCDR2 aligns to four at most.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "datasets/logs/ros/messages/message_definition.hpp"

namespace odobench {

// Bytes that do not fit the type; the text says what was found.
class BadMessage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Elements of arrays that are looked at one by one, per message.
inline constexpr std::uint64_t kMostMessageElements = std::uint64_t{1} << 20;

class MessageWire {
 public:
  MessageWire() = default;
  MessageWire(RosEncoding encoding, std::string_view message);  // throws BadMessage

  std::uint64_t at = 0;  // bytes taken so far

  std::uint64_t most_alignment() const { return most_alignment_; }
  std::uint64_t left() const { return bytes_.size() - at; }
  const char* begin() const { return bytes_.data(); }
  const char* here() const { return bytes_.data() + at; }

  // All of these throw BadMessage when the bytes do not suffice.
  void need(std::uint64_t count) const {
    if (count > left()) fail_short(count);
  }
  void align(std::uint64_t size) {
    if (size > most_alignment_) size = most_alignment_;
    const std::uint64_t padding = (size - at % size) % size;
    need(padding);
    at += padding;
  }
  std::uint64_t length();
  std::string_view string();
  // Counts elements of arrays against kMostMessageElements.
  void count_elements(std::uint64_t more);
  // At the end of the message: CDR may pad to a multiple of four.
  void require_end() const;

  // A number at `bytes`; stamps in seconds. Not for strings and messages.
  double value(RosPrimitive primitive, const char* bytes) const;
  // Integers as they are, stamps in nanoseconds.
  std::int64_t integer(RosPrimitive primitive, const char* bytes) const;

 private:
  [[noreturn]] void fail_short(std::uint64_t count) const;

  std::string_view bytes_;
  std::uint64_t elements_ = 0, most_alignment_ = 1;
  bool swap_ = false, cdr_ = false;
};

}  // namespace odobench
