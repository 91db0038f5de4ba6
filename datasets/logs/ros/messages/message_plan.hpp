// How a message's bytes are walked through for some of its values: compiled once per type and paths. What has
// a fixed size is one step, whatever is wanted of it; the rest is passed over string by string and array by
// array.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "datasets/logs/ros/messages/message_definition.hpp"

namespace odobench {

struct MessageRequest {
  std::vector<std::string> numbers, text;  // paths
  std::string time;                        // "": none
};

// Bytes of something of fixed size, by the place modulo 8 where it begins (alignment). In ROS 1, which packs,
// all are equal.
using SizeByPlace = std::array<std::uint64_t, 8>;
// Of `count` of them one after the other, at most kHugeSize.
std::uint64_t repeated_size(const SizeByPlace& size, std::uint64_t place, std::uint64_t count);
inline constexpr std::uint64_t kHugeSize = std::uint64_t{1} << 40;

struct PlanTarget {
  enum class Kind : unsigned char { Number, Text, Time, Key } kind = Kind::Number;
  std::size_t slot = 0;
};

struct PlanStep {
  enum class Kind : unsigned char {
    Fixed,     // `size`, `reads`
    String,    // `picks`
    Numbers,   // array of numbers: `primitive`, `picks`, `column`
    Strings,   // array of strings: `picks`, `keys`
    Messages,  // array of messages: `size` or `program` of one, `elements`
    Call,      // `program`
    Resolve    // `lookups`: values by name, now that names and values are known
  };
  struct Read {
    SizeByPlace offset;
    RosPrimitive primitive;
    PlanTarget target;
  };
  struct Pick {
    std::uint64_t index;
    PlanTarget target;
  };
  struct Element {
    std::optional<std::uint64_t> index;  // else all that `group` selects
    std::size_t group = 0, program = 0;
  };
  struct Lookup {
    std::size_t keys, value, column;
    RosPrimitive primitive;
    PlanTarget target;
  };

  Kind kind = Kind::Fixed;
  RosPrimitive primitive = RosPrimitive::Uint8;
  bool counted = false;  // of arrays: the count stands before the elements, else it is `length`
  bool fixed = false;    // of messages: `size` is that of an element
  std::uint64_t length = 0;
  SizeByPlace size = {};
  std::optional<std::size_t> keys, column;
  std::size_t program = 0;
  std::vector<Read> reads;
  std::vector<Pick> picks;
  std::vector<Element> elements;
  std::vector<Lookup> lookups;
};

struct MessagePlan {
  // Elements of an array of messages that are told by their fields.
  struct Group {
    struct Selector {
      std::size_t key;  // slot
      std::string text;
      std::optional<double> number;
    };
    std::string path;
    std::vector<Selector> selectors;
    std::vector<PlanTarget> targets;
  };

  std::uint64_t most_alignment = 1;
  std::vector<std::vector<PlanStep>> programs;  // [0]: the message
  std::vector<Group> groups;
  std::vector<std::vector<std::string>> keys;  // names that are looked for, table by table
  std::size_t columns = 0, key_slots = 0;
  RosPrimitive time = RosPrimitive::Time;  // of the time path
};

// `most_alignment`: 8 (CDR), 4 (XCDR2), 1 (ROS 1). An unknown field is a std::invalid_argument "no field
// 'lefft' in courier_msgs/WheelTicks, did you mean 'left'? it has header.stamp, left,
// right"; so is a path that fits no value.
MessagePlan plan_message(const RosTypes& types, const MessageRequest& request, std::uint64_t most_alignment);

// Paths of the numbers, stamps and strings of a type, at most `most`; of arrays the one with [0].
std::vector<std::string> message_leaves(const RosTypes& types, std::size_t most);

// The path of the stamp of what is asked for: that of the elements that a path of the request selects, else
// "header.stamp", else that of the first message in an array ("transforms[0].header.stamp"); "" without one.
std::string default_time_path(const RosTypes& types, const MessageRequest& request);

}  // namespace odobench
