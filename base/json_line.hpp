// On which line of a text a value of its JSON stands.
#pragma once

#include <cstddef>
#include <string_view>

namespace odobench {

// The line, from 1, on which the value at `path` ("/solvers/2/options/swarm", keys as they stand in the text)
// begins, of a member that of its key. `text` is correct JSON; 1 where it has no such value.
std::size_t json_line(std::string_view text, std::string_view path);

}  // namespace odobench
