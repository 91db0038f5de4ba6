// Stamps as files write them, "1760000000.123456789" or "1.76e9", in whole nanoseconds: a double of Unix
// time is exact to 2e-7 s only.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace odobench {

// Stamps are at most this far from zero (126 years), so that differences of two fit.
inline constexpr std::int64_t kLargestStamp_ns = 4'000'000'000'000'000'000;

// `digits`: the unit is 10^digits ns (9: s, 6: ms, 3: us, 0: ns). What is finer than 1 ns is rounded.
// Nothing where the text is no decimal number, with point or comma, or beyond kLargestStamp_ns.
std::optional<std::int64_t> decimal_nanoseconds(std::string_view text, int digits);

}  // namespace odobench
