#include "datasets/logs/ros/messages/message_definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <map>
#include <utility>

#include "base/files.hpp"
#include "base/text.hpp"

namespace odobench {
namespace {

struct PrimitiveFacts {
  const char* name;
  RosPrimitive primitive;
  std::uint64_t size;
};
// The first name of each is that of messages to the user.
constexpr std::array kPrimitives{PrimitiveFacts{"bool", RosPrimitive::Bool, 1},
                                 PrimitiveFacts{"int8", RosPrimitive::Int8, 1},
                                 PrimitiveFacts{"uint8", RosPrimitive::Uint8, 1},
                                 PrimitiveFacts{"int16", RosPrimitive::Int16, 2},
                                 PrimitiveFacts{"uint16", RosPrimitive::Uint16, 2},
                                 PrimitiveFacts{"int32", RosPrimitive::Int32, 4},
                                 PrimitiveFacts{"uint32", RosPrimitive::Uint32, 4},
                                 PrimitiveFacts{"int64", RosPrimitive::Int64, 8},
                                 PrimitiveFacts{"uint64", RosPrimitive::Uint64, 8},
                                 PrimitiveFacts{"float32", RosPrimitive::Float32, 4},
                                 PrimitiveFacts{"float64", RosPrimitive::Float64, 8},
                                 PrimitiveFacts{"time", RosPrimitive::Time, 8},
                                 PrimitiveFacts{"duration", RosPrimitive::Time, 8},
                                 PrimitiveFacts{"builtin_interfaces/Time", RosPrimitive::Time, 8},
                                 PrimitiveFacts{"builtin_interfaces/Duration", RosPrimitive::Time, 8},
                                 PrimitiveFacts{"string", RosPrimitive::String, 0},
                                 PrimitiveFacts{"message", RosPrimitive::Message, 0},
                                 PrimitiveFacts{"char", RosPrimitive::Uint8, 1}};

const PrimitiveFacts& facts_of(RosPrimitive primitive) {
  return *std::find_if(kPrimitives.begin(), kPrimitives.end(),
                       [&](const PrimitiveFacts& f) { return f.primitive == primitive; });
}

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\f\v");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\f\v") - begin + 1);
}

bool is_name(std::string_view text) {
  const auto part = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !text.empty() && std::all_of(text.begin(), text.end(), part);
}

std::string_view package_of(std::string_view type) {
  return type.substr(0, type.find('/'));
}
std::string_view base_name_of(std::string_view type) {
  return type.substr(type.rfind('/') + 1);
}

class DefinitionParser {
 public:
  DefinitionParser(RosEncoding encoding, const std::vector<std::filesystem::path>& messages)
      : encoding_(encoding) {
    for (const std::filesystem::path& file : messages)
      files_.emplace_back(file.stem().string(), read_file(file, kLongestDefinition));
  }

  RosTypes parse(std::string_view written, const std::string* definition) {
    const std::string type = short_type_name(written);
    written_ = written;
    if (definition != nullptr) split(type, *definition);
    require(type, find(type, ""));
    return std::move(result_);
  }

 private:
  [[noreturn]] static void fail(const std::string& why) { throw BadDefinition(why); }
  void split(const std::string& type, std::string_view text);
  std::pair<std::string, std::string_view> find(const std::string& name, std::string_view from) const;
  std::size_t require(const std::string& wanted, const std::pair<std::string, std::string_view>& found);
  void line(std::size_t type, std::string_view text);
  void set_type(RosField& field, std::string_view word, const std::string& owner);
  static std::string_view take_array(RosField& field, std::string_view word);
  int depth_of(std::size_t type) const;

  RosEncoding encoding_;
  std::string written_;                                     // the main type as the file writes it
  std::vector<std::pair<std::string, std::string>> files_;  // name without package, text
  std::map<std::string, std::string_view, std::less<>> sections_;
  std::map<std::string, std::size_t, std::less<>> done_;  // place in result_, kOpen while it is read
  RosTypes result_;
  std::size_t fields_ = 0;
  int depth_ = 0;
  static constexpr std::size_t kOpen = ~std::size_t{0};
};

// The sections of the text, by name.
void DefinitionParser::split(const std::string& type, std::string_view text) {
  if (text.size() > kLongestDefinition)
    fail(fmt::format("its definition has more than {} bytes", kLongestDefinition));
  std::string name = type;
  while (true) {
    std::size_t begin = text.rfind("\n====", 0) == 0 ? 0 : text.find("\n====");
    sections_.emplace(name, text.substr(0, begin));
    if (begin == std::string_view::npos) return;
    begin = text.find('\n', begin + 1);
    if (begin == std::string_view::npos) return;
    text.remove_prefix(begin + 1);
    const std::string_view title = trimmed(text.substr(0, text.find('\n')));
    if (title.substr(0, 4) != "MSG:")
      fail(fmt::format("found '{}' behind a line of '=' in its definition, expected MSG: and a type",
                       shown(title)));
    name = short_type_name(trimmed(title.substr(4)));
    const auto end = text.find('\n');
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end);
  }
}

// Full name and text of a type as a message of package `from` writes it.
std::pair<std::string, std::string_view> DefinitionParser::find(const std::string& name,
                                                                std::string_view from) const {
  std::vector<std::string> candidates{name};
  if (name.find('/') == std::string::npos)
    candidates = {fmt::format("{}/{}", from, name), name == "Header" ? "std_msgs/Header" : name};
  for (const std::string& candidate : candidates)
    if (const auto found = sections_.find(candidate); found != sections_.end()) return *found;
  for (const auto& [file, text] : files_)
    if (file == base_name_of(name)) return {candidates.front(), text};
  if (encoding_ == RosEncoding::Cdr)
    for (const std::string& candidate : candidates)
      if (const std::string_view text = standard_message(candidate); !text.empty()) return {candidate, text};
  if (sections_.empty())
    fail(fmt::format(
        "type {} has no definition in this file{}: give --msg={}.msg", shown(from.empty() ? written_ : name),
        encoding_ == RosEncoding::Cdr ? " (recorded before ROS 2 Iron)" : "", shown(base_name_of(name))));
  fail(fmt::format("its definition has no type {}", shown(name)));
}

std::size_t DefinitionParser::require(const std::string& wanted,
                                      const std::pair<std::string, std::string_view>& found) {
  const auto& [name, text] = found;
  if (const auto known = done_.find(name); known != done_.end()) {
    if (known->second == kOpen) fail(fmt::format("type {} contains itself", shown(name)));
    return known->second;
  }
  if (++depth_ > kDeepestMessage) fail(fmt::format("types are nested deeper than {}", kDeepestMessage));
  done_[name] = kOpen;
  const std::size_t place = result_.types.size();
  result_.types.emplace_back().name = name.empty() ? wanted : name;
  for (std::string_view rest = text; !rest.empty();) {
    const auto end = rest.find('\n');
    line(place, trimmed(rest.substr(0, end)));
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  }
  // In CDR an empty message has one byte.
  if (result_.types[place].fields.empty() && encoding_ == RosEncoding::Cdr)
    result_.types[place].fields.emplace_back().name = "structure_needs_at_least_one_member";
  --depth_;
  done_[name] = place;
  if (depth_of(place) > kDeepestMessage)
    fail(fmt::format("types are nested deeper than {}", kDeepestMessage));
  return place;
}

int DefinitionParser::depth_of(std::size_t type) const {
  // Types come in the order of their first use: a type's parts that were known before may be deep, too.
  std::vector<int> depth(result_.types.size(), 0);
  const std::function<int(std::size_t)> look = [&](std::size_t t) {
    if (depth[t] > 0) return depth[t];
    int deepest = 0;
    for (const RosField& field : result_.types[t].fields)
      if (field.primitive == RosPrimitive::Message) deepest = std::max(deepest, look(field.type));
    return depth[t] = deepest + 1;
  };
  return look(type);
}

// One line of a type: "TYPE NAME [DEFAULT]", "TYPE NAME=CONSTANT", a comment or nothing.
void DefinitionParser::line(std::size_t type, std::string_view text) {
  text = trimmed(text.substr(0, text.find('#')));
  if (text.empty()) return;
  if (text.substr(0, 3) == "---") fail("its definition is that of a service or an action, not of a message");
  const auto space = text.find_first_of(" \t");
  if (space == std::string_view::npos)
    fail(fmt::format("found '{}' in its definition, expected a type and a name", shown(text)));
  const std::string_view word = text.substr(0, space);
  const std::string_view rest = trimmed(text.substr(space));
  const std::string_view name = rest.substr(0, rest.find_first_of(" \t="));
  const std::string_view behind = trimmed(rest.substr(name.size()));
  if (!behind.empty() && behind[0] == '=') return;  // a constant
  if (!is_name(name)) fail(fmt::format("found '{}' in its definition, expected a name", shown(rest)));
  if (++fields_ > kMostMessageFields)
    fail(fmt::format("its definition has more than {} fields", kMostMessageFields));
  RosField field;
  field.name = name;
  set_type(field, word, result_.types[type].name);
  result_.types[type].fields.push_back(std::move(field));
}

// Takes "[N]", "[]", "[<=N]" off the end of the word.
std::string_view DefinitionParser::take_array(RosField& field, std::string_view word) {
  const auto open = word.find('[');
  if (open == std::string_view::npos) return word;
  std::string_view inside = word.substr(open + 1);
  if (inside.empty() || inside.back() != ']')
    fail(fmt::format("found '{}' in its definition, expected an array type", shown(word)));
  inside.remove_suffix(1);
  field.array = RosField::Array::Sequence;
  if (!inside.empty() && inside.substr(0, 2) != "<=") {
    field.array = RosField::Array::Fixed;
    const char* end = inside.data() + inside.size();
    const auto [stop, error] = std::from_chars(inside.data(), end, field.length);
    if (error != std::errc{} || stop != end || field.length > 0xFFFFFFFF)
      fail(fmt::format("found '{}' in its definition, expected an array's length", shown(word)));
  }
  return word.substr(0, open);
}

void DefinitionParser::set_type(RosField& field, std::string_view word, const std::string& owner) {
  word = take_array(field, word);
  word = word.substr(0, word.find("<="));  // of a string: its longest length
  const std::string name = short_type_name(word);
  if (name.substr(0, 7) == "wstring") fail(fmt::format("field {} is a wstring", shown(field.name)));
  if (name == "byte") {
    field.primitive = encoding_ == RosEncoding::Ros1 ? RosPrimitive::Int8 : RosPrimitive::Uint8;
    return;
  }
  const std::string full = (name == "Time" || name == "Duration") && package_of(owner) == "builtin_interfaces"
                               ? "builtin_interfaces/" + name
                               : name;
  for (const PrimitiveFacts& known : kPrimitives) {
    if (full != known.name || known.primitive == RosPrimitive::Message) continue;
    field.primitive = known.primitive;
    return;
  }
  field.primitive = RosPrimitive::Message;
  field.type = require(name, find(name, package_of(owner)));
}

}  // namespace

std::shared_ptr<const std::string> definition_text(std::string_view text) {
  return std::make_shared<const std::string>(text.substr(0, kLongestDefinition + 1));
}

const char* primitive_name(RosPrimitive primitive) {
  return facts_of(primitive).name;
}
std::uint64_t primitive_size(RosPrimitive primitive) {
  return facts_of(primitive).size;
}

const RosField* RosType::find(std::string_view field) const {
  for (const RosField& f : fields)
    if (f.name == field) return &f;
  return nullptr;
}

std::string short_type_name(std::string_view type) {
  const auto middle = type.find("/msg/");
  if (middle == std::string_view::npos) return std::string(type);
  return fmt::format("{}/{}", type.substr(0, middle), type.substr(middle + 5));
}

RosTypes parse_message_definition(std::string_view type, const std::string* definition, RosEncoding encoding,
                                  const std::vector<std::filesystem::path>& messages) {
  return DefinitionParser(encoding, messages).parse(type, definition);
}

}  // namespace odobench
