// Paths to values of messages: "pose.position.x", "data[0]", "position[name=left]" (of arrays that go side by
// side), "transforms[header.frame_id=odom,child_frame_id=base].transform.rotation.z" (of an array of
// messages).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace odobench {

struct PathStep {
  std::string name;
  std::optional<std::uint64_t> index;
  struct Selector {
    std::string key;  // a path without brackets
    std::string value;
  };
  std::vector<Selector> selectors;

  bool in_array() const { return index.has_value() || !selectors.empty(); }
};

// Throws std::invalid_argument "field 'a[': ...".
std::vector<PathStep> parse_message_path(std::string_view path);

// The step as it is written.
std::string path_step_text(const PathStep& step);

}  // namespace odobench
