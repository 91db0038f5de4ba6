#include "datasets/csv/decimal_time.hpp"

#include <charconv>
#include <string>

namespace odobench {
namespace {

constexpr int kLargestExponent = 40;
constexpr std::size_t kLongestNumber = 64;

// The digits at the front of `text`, taken off.
std::string_view take_digits(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789"), text.size());
  const std::string_view digits = text.substr(0, end);
  text.remove_prefix(end);
  return digits;
}

bool take_sign(std::string_view& text) {
  const bool minus = !text.empty() && text.front() == '-';
  if (minus || (!text.empty() && text.front() == '+')) text.remove_prefix(1);
  return minus;
}

// "e-3" at the end; nothing where something else is left.
std::optional<int> take_exponent(std::string_view text) {
  if (text.empty()) return 0;
  if (text.front() != 'e' && text.front() != 'E') return std::nullopt;
  text.remove_prefix(1);
  const bool minus = take_sign(text);
  const std::string_view digits = take_digits(text);
  int exponent = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
  if (digits.empty() || !text.empty() || error != std::errc() || exponent > kLargestExponent)
    return std::nullopt;
  return minus ? -exponent : exponent;
}

// "1760000000.123456789" as nearly all stamps are written: at most 19 digits, no exponent, nothing to round.
// Nothing where the text is something else, or no number at all.
std::optional<std::int64_t> usual_nanoseconds(std::string_view text, int digits) {
  constexpr std::int64_t powers[] = {1,       10,        100,        1'000,       10'000,
                                     100'000, 1'000'000, 10'000'000, 100'000'000, 1'000'000'000};
  const bool minus = take_sign(text);
  if (text.empty() || text.size() > 20) return std::nullopt;
  std::uint64_t value = 0;
  std::size_t count = 0, behind = 0;
  bool point = false;
  for (const char c : text) {
    const auto digit = static_cast<unsigned>(c - '0');
    if (digit > 9) {
      if (point || (c != '.' && c != ',')) return std::nullopt;
      point = true;
      continue;
    }
    value = 10 * value + digit;
    ++count;
    behind += point ? 1 : 0;
  }
  const auto shift = static_cast<std::size_t>(digits) - behind;
  if (count == 0 || count > 19 || behind > static_cast<std::size_t>(digits) || shift > 9 ||
      value > static_cast<std::uint64_t>(kLargestStamp_ns / powers[shift]))
    return std::nullopt;
  const auto stamp = static_cast<std::int64_t>(value) * powers[shift];
  return minus ? -stamp : stamp;
}

}  // namespace

std::optional<std::int64_t> decimal_nanoseconds(std::string_view text, int digits) {
  if (const std::optional<std::int64_t> usual = usual_nanoseconds(text, digits)) return usual;
  if (text.size() > kLongestNumber) return std::nullopt;
  const bool minus = take_sign(text);
  std::string number(take_digits(text));
  std::string_view fraction;
  if (!text.empty() && (text.front() == '.' || text.front() == ',')) {
    text.remove_prefix(1);
    fraction = take_digits(text);
  }
  const std::optional<int> exponent = take_exponent(text);
  number += fraction;
  if (!exponent || number.empty()) return std::nullopt;
  const int shift = digits + *exponent - static_cast<int>(fraction.size());
  bool up = false;
  if (shift >= 0) {
    number.append(static_cast<std::size_t>(shift), '0');
  } else {
    const auto cut = static_cast<std::size_t>(-shift);
    up = cut <= number.size() && number[number.size() - cut] >= '5';
    number.resize(number.size() - std::min(cut, number.size()));
  }
  number.erase(0, number.find_first_not_of('0'));
  std::int64_t value = 0;
  if (!number.empty()) {
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc() || value > kLargestStamp_ns) return std::nullopt;
  }
  if (up) ++value;
  return minus ? -value : value;
}

}  // namespace odobench
