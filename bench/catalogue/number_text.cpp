#include "bench/catalogue/number_text.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace odobench {
namespace {

template <class T>
bool parse_all(const std::string& text, T& out) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, out);
  return error == std::errc() && stop == end;
}

}  // namespace

std::int64_t whole_number(const std::string& option, const std::string& text, std::int64_t lowest,
                          std::int64_t highest) {
  std::int64_t value = 0;
  bool whole = parse_all(text, value);
  double real = 0;
  constexpr double kExact = 9007199254740992.0;  // 2^53: every whole number up to it is a double
  if (!whole && parse_all(text, real) && std::abs(real) <= kExact && real == std::floor(real)) {
    value = static_cast<std::int64_t>(real);
    whole = true;
  }
  if (whole && value >= lowest && value <= highest) return value;
  const bool open = highest == std::numeric_limits<std::int64_t>::max();
  throw std::invalid_argument(
      fmt::format("{}={}: expected a whole number {}", option, text,
                  open ? fmt::format(">= {}", lowest) : fmt::format("in {}..{}", lowest, highest)));
}

std::uint64_t seed_number(const std::string& option, const std::string& text) {
  std::uint64_t value = 0;
  if (!parse_all(text, value))
    throw std::invalid_argument(fmt::format("{}={}: expected a whole number in 0..{}", option, text,
                                            std::numeric_limits<std::uint64_t>::max()));
  return value;
}

double finite_number(const std::string& option, const std::string& text, bool positive, double most) {
  double value = 0;
  if (!parse_all(text, value) || !std::isfinite(value) || (positive && !(value > 0)))
    throw std::invalid_argument(
        fmt::format("{}={}: expected a finite number{}", option, text, positive ? " > 0" : ""));
  if (std::abs(value) > most)
    throw std::invalid_argument(
        fmt::format("{}={}: expected at most {:g}{}", option, text, most, positive ? "" : " in size"));
  return value;
}

}  // namespace odobench
