// What somebody may have meant who mistyped a name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace odobench {

// The entry of `known` nearest to `word` by edit distance, "" when none is near enough to be meant.
std::string nearest_name(std::string_view word, const std::vector<std::string>& known);

// ", did you mean 'NAME'?" of the nearest, "" when there is none.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace odobench
