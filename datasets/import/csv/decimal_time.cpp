#include "datasets/import/csv/decimal_time.hpp"

#include <charconv>
#include <string>

namespace odobench::csv_import {
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

}  // namespace

std::optional<std::int64_t> decimal_nanoseconds(std::string_view text, int digits) {
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

}  // namespace odobench::csv_import
