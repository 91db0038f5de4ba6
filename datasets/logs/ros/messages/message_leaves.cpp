// What a type of message has, from its definition alone.
#include <functional>

#include "datasets/logs/ros/messages/message_path.hpp"
#include "datasets/logs/ros/messages/message_plan.hpp"

namespace odobench {
namespace {

bool is_stamped(const RosTypes& types, std::size_t type) {
  const RosField* header = types.types[type].find("header");
  if (header == nullptr || header->primitive != RosPrimitive::Message ||
      header->array != RosField::Array::None)
    return false;
  const RosField* stamp = types.types[header->type].find("stamp");
  return stamp != nullptr && stamp->primitive == RosPrimitive::Time && stamp->array == RosField::Array::None;
}

// "transforms[...]" of a path through it, with what stands before; "" when no step of the path selects.
std::string selected_element(const RosTypes& types, const std::string& path) {
  std::size_t type = 0;
  std::string prefix;
  for (const PathStep& step : parse_message_path(path)) {
    const RosField* f = types.types[type].find(step.name);
    if (f == nullptr || f->primitive != RosPrimitive::Message) return "";
    prefix += (prefix.empty() ? "" : ".") + path_step_text(step);
    type = f->type;
    if (!step.selectors.empty()) return is_stamped(types, type) ? prefix : "";
  }
  return "";
}

}  // namespace

std::vector<std::string> message_leaves(const RosTypes& types, std::size_t most) {
  std::vector<std::string> leaves;
  std::size_t looked = 0;
  const std::function<void(std::size_t, const std::string&)> look = [&](std::size_t type,
                                                                        const std::string& prefix) {
    for (const RosField& f : types.types[type].fields) {
      if (leaves.size() >= most || ++looked > 16 * most) return;
      const std::string path = prefix + f.name + (f.array == RosField::Array::None ? "" : "[0]");
      if (f.primitive == RosPrimitive::Message)
        look(f.type, path + ".");
      else
        leaves.push_back(path);
    }
  };
  look(0, "");
  return leaves;
}

std::string default_time_path(const RosTypes& types, const MessageRequest& request) {
  for (const auto* paths : {&request.numbers, &request.text})
    for (const std::string& path : *paths)
      if (const std::string element = selected_element(types, path); !element.empty())
        return element + ".header.stamp";
  if (is_stamped(types, 0)) return "header.stamp";
  for (const RosField& f : types.types[0].fields)
    if (f.primitive == RosPrimitive::Message && f.array != RosField::Array::None && is_stamped(types, f.type))
      return f.name + "[0].header.stamp";
  return "";
}

}  // namespace odobench
