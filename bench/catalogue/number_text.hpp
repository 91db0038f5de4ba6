// Numbers as users type them, with errors that name the option, what was found and what was expected.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace odobench {

// A whole number in [lowest, highest]; "1e5" and "100000.0" are whole numbers. Throws std::invalid_argument
// "--max-evals=0: expected a whole number >= 1".
std::int64_t whole_number(const std::string& option, const std::string& text, std::int64_t lowest,
                          std::int64_t highest = std::numeric_limits<std::int64_t>::max());

// 0 .. 2^64-1, decimal.
std::uint64_t seed_number(const std::string& option, const std::string& text);

// A finite number, > 0 when `positive`. Throws std::invalid_argument.
double finite_number(const std::string& option, const std::string& text, bool positive,
                     double most = std::numeric_limits<double>::infinity());

}  // namespace odobench
