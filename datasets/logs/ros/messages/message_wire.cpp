#include "datasets/logs/ros/messages/message_wire.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <type_traits>

namespace odobench {
namespace {

template <class T>
T wire_number(const char* bytes, bool swap) {
  T value;
  if (!swap) {
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  char reversed[sizeof(T)];
  for (std::size_t i = 0; i < sizeof(T); ++i) reversed[i] = bytes[sizeof(T) - 1 - i];
  std::memcpy(&value, reversed, sizeof value);
  return value;
}

// Applies `use` to the number in its own type; not for stamps.
template <class Use>
auto with_number(RosPrimitive primitive, const char* bytes, bool swap, Use use) {
  switch (primitive) {
    case RosPrimitive::Int8:
      return use(wire_number<std::int8_t>(bytes, swap));
    case RosPrimitive::Int16:
      return use(wire_number<std::int16_t>(bytes, swap));
    case RosPrimitive::Uint16:
      return use(wire_number<std::uint16_t>(bytes, swap));
    case RosPrimitive::Int32:
      return use(wire_number<std::int32_t>(bytes, swap));
    case RosPrimitive::Uint32:
      return use(wire_number<std::uint32_t>(bytes, swap));
    case RosPrimitive::Int64:
      return use(wire_number<std::int64_t>(bytes, swap));
    case RosPrimitive::Uint64:
      return use(wire_number<std::uint64_t>(bytes, swap));
    case RosPrimitive::Float32:
      return use(wire_number<float>(bytes, swap));
    case RosPrimitive::Float64:
      return use(wire_number<double>(bytes, swap));
    default:
      return use(wire_number<std::uint8_t>(bytes, swap));
  }
}

}  // namespace

MessageWire::MessageWire(RosEncoding encoding, std::string_view message) : bytes_(message) {
  if (encoding == RosEncoding::Ros1) return;
  if (message.size() < 4) throw BadMessage(fmt::format("found {} bytes, expected 4 of CDR", message.size()));
  const auto high = static_cast<unsigned char>(message[0]), low = static_cast<unsigned char>(message[1]);
  if (high != 0 || (low != 0 && low != 1 && low != 6 && low != 7))
    throw BadMessage(fmt::format(
        "found CDR encapsulation {:02x} {:02x}, expected 00 00, 00 01, 00 06 or 00 07", high, low));
  bytes_ = message.substr(4);
  cdr_ = true;
  swap_ = low == 0 || low == 6;
  most_alignment_ = low >= 6 ? 4 : 8;
}

void MessageWire::fail_short(std::uint64_t count) const {
  throw BadMessage(fmt::format("found {} bytes behind byte {}, expected {}", left(), at, count));
}

std::uint64_t MessageWire::length() {
  align(4);
  need(4);
  const auto value = wire_number<std::uint32_t>(here(), swap_);
  at += 4;
  return value;
}

std::string_view MessageWire::string() {
  const std::uint64_t size = length();
  need(size);
  std::string_view text(here(), static_cast<std::size_t>(size));
  at += size;
  if (cdr_ && !text.empty() && text.back() == '\0') text.remove_suffix(1);
  return text;
}

void MessageWire::count_elements(std::uint64_t more) {
  elements_ += more;
  if (elements_ > kMostMessageElements)
    throw BadMessage(fmt::format("arrays of more than {} elements", kMostMessageElements));
}

void MessageWire::require_end() const {
  if (left() > (cdr_ ? 3 : 0)) throw BadMessage(fmt::format("{} bytes are left behind its fields", left()));
}

double MessageWire::value(RosPrimitive primitive, const char* bytes) const {
  if (primitive == RosPrimitive::Time) return 1e-9 * static_cast<double>(integer(primitive, bytes));
  return with_number(primitive, bytes, swap_, [](auto number) { return static_cast<double>(number); });
}

std::int64_t MessageWire::integer(RosPrimitive primitive, const char* bytes) const {
  if (primitive != RosPrimitive::Time)
    return with_number(primitive, bytes, swap_, [](auto number) -> std::int64_t {
      if constexpr (std::is_floating_point_v<decltype(number)>)
        return std::abs(number) < 9e18 ? std::llround(number) : 0;
      else
        return static_cast<std::int64_t>(number);
    });
  const auto seconds = wire_number<std::uint32_t>(bytes, swap_);
  const std::int64_t whole = cdr_ ? static_cast<std::int32_t>(seconds) : std::int64_t{seconds};
  return whole * 1'000'000'000 + wire_number<std::uint32_t>(bytes + 4, swap_);
}

}  // namespace odobench
