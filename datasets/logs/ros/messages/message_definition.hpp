// Message types of ROS 1 and ROS 2 from their definition's text (wiki.ros.org/msg,
// docs.ros.org: "About ROS 2 interfaces"): the main type's fields, then, behind lines of '=', those of the
// types in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace odobench {

// How messages are serialised.
enum class RosEncoding { Ros1, Cdr, Json };

enum class RosPrimitive : unsigned char {
  Bool,
  Int8,
  Uint8,
  Int16,
  Uint16,
  Int32,
  Uint32,
  Int64,
  Uint64,
  Float32,
  Float64,
  Time,  // and duration: seconds and nanoseconds, 32 bits each
  String,
  Message
};
const char* primitive_name(RosPrimitive primitive);
// Of a number or a time [bytes]; strings and messages have no size of their own.
std::uint64_t primitive_size(RosPrimitive primitive);

struct RosField {
  enum class Array : unsigned char { None, Fixed, Sequence };

  std::string name;
  RosPrimitive primitive = RosPrimitive::Uint8;
  std::size_t type = 0;  // of a message: its place in RosTypes::types
  Array array = Array::None;
  std::uint64_t length = 0;  // of a fixed array
};

struct RosType {
  std::string name;  // "package/Name"
  std::vector<RosField> fields;
  const RosField* find(std::string_view field) const;
};

// types[0] is the main one. No type contains itself.
struct RosTypes {
  std::vector<RosType> types;
};

// A message type that cannot be read; the text says why.
class BadDefinition : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr std::size_t kLongestDefinition = 64 << 10;  // [bytes]
inline constexpr std::size_t kMostMessageFields = 2000;      // of all types of a definition
inline constexpr int kDeepestMessage = 16;

// "pkg/msg/Name" as "pkg/Name".
std::string short_type_name(std::string_view type);

// The types behind `type`. `definition` null: the standard messages that are built in, and those of the files
// `messages` ("Name.msg" defines Name of any package), which also serve for types that the text does not
// have. Throws BadDefinition; DataError when one of `messages` cannot be read.
RosTypes parse_message_definition(std::string_view type, const std::string* definition, RosEncoding encoding,
                                  const std::vector<std::filesystem::path>& messages);

// A definition as it is kept: of one that is too long as much as tells so.
std::shared_ptr<const std::string> definition_text(std::string_view text);

// The definition of a standard message ("geometry_msgs/Pose"), "" when it is not built in.
std::string_view standard_message(std::string_view type);

}  // namespace odobench
