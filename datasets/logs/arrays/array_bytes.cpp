#include <algorithm>
#include <cstring>
#include <limits>

#include "datasets/logs/arrays/array_log.hpp"
#include "datasets/logs/log_names.hpp"

namespace odobench {
namespace {

constexpr std::uint64_t kMostNumbers = std::uint64_t{1} << 40;
constexpr std::size_t kPieceOfNumbers = 4096;

template <class T, class To>
void convert_as(const char* bytes, std::size_t count, bool swap, std::vector<To>& to) {
  to.resize(count);
  char turned[sizeof(T)];
  for (std::size_t i = 0; i < count; ++i) {
    T value;
    if (swap) {
      std::reverse_copy(bytes + i * sizeof(T), bytes + (i + 1) * sizeof(T), turned);
      std::memcpy(&value, turned, sizeof(T));
    } else {
      std::memcpy(&value, bytes + i * sizeof(T), sizeof(T));
    }
    to[i] = static_cast<To>(value);
  }
}

// Numbers beyond 2^63 are the largest int64.
void convert_unsigned(const char* bytes, std::size_t count, bool swap, std::vector<std::int64_t>& to) {
  convert_as<std::int64_t>(bytes, count, swap, to);
  for (std::int64_t& value : to)
    if (value < 0) value = std::numeric_limits<std::int64_t>::max();
}

}  // namespace

std::size_t bytes_of(NumberType type) {
  switch (type) {
    case NumberType::Int8:
    case NumberType::Uint8:
    case NumberType::Bool:
      return 1;
    case NumberType::Int16:
    case NumberType::Uint16:
      return 2;
    case NumberType::Int32:
    case NumberType::Uint32:
    case NumberType::Single:
      return 4;
    default:
      return 8;
  }
}

const char* name_of(NumberType type) {
  constexpr const char* names[] = {"int8",  "uint8",  "int16",   "uint16",  "int32", "uint32",
                                   "int64", "uint64", "float32", "float64", "bool"};
  return names[static_cast<std::size_t>(type)];
}

bool is_number_of_matlab(unsigned class_number) {
  return class_number >= 6 && class_number <= 15;
}

NumberType number_type_of_matlab(unsigned class_number) {
  if (class_number == 6) return NumberType::Double;
  if (class_number == 7) return NumberType::Single;
  return static_cast<NumberType>(class_number - 8);  // int8, uint8, ... in the order of NumberType
}

bool shape_of(const std::vector<std::uint64_t>& dimensions, ArrayHead& head) {
  std::uint64_t product = 1, columns = 1;
  for (const std::uint64_t n : dimensions)
    if (__builtin_mul_overflow(product, n, &product) || product > kMostNumbers) return false;
  const auto above_one = std::count_if(dimensions.begin(), dimensions.end(), [](auto n) { return n != 1; });
  if (above_one > 1) {
    const std::uint64_t rows = dimensions[0];
    columns = rows == 0 ? 1 : product / rows;
  }
  if (columns > kMostColumns) return false;
  head.columns = static_cast<std::size_t>(std::max<std::uint64_t>(columns, 1));
  head.rows = static_cast<std::size_t>(product) / head.columns;
  return true;
}

void ArrayBytes::convert(const char* bytes, std::size_t count) {
  switch (type_) {
    case NumberType::Int8:
      convert_as<std::int8_t>(bytes, count, swap_, whole_);
      break;
    case NumberType::Bool:
    case NumberType::Uint8:
      convert_as<std::uint8_t>(bytes, count, swap_, whole_);
      break;
    case NumberType::Int16:
      convert_as<std::int16_t>(bytes, count, swap_, whole_);
      break;
    case NumberType::Uint16:
      convert_as<std::uint16_t>(bytes, count, swap_, whole_);
      break;
    case NumberType::Int32:
      convert_as<std::int32_t>(bytes, count, swap_, whole_);
      break;
    case NumberType::Uint32:
      convert_as<std::uint32_t>(bytes, count, swap_, whole_);
      break;
    case NumberType::Int64:
      convert_as<std::int64_t>(bytes, count, swap_, whole_);
      break;
    case NumberType::Uint64:
      convert_unsigned(bytes, count, swap_, whole_);
      break;
    case NumberType::Single:
      convert_as<float>(bytes, count, swap_, real_);
      break;
    case NumberType::Double:
      convert_as<double>(bytes, count, swap_, real_);
      break;
  }
  const bool reals = type_ == NumberType::Single || type_ == NumberType::Double;
  visitor_.numbers(reals ? nullptr : whole_.data(), reals ? real_.data() : nullptr, count);
}

void ArrayBytes::take(std::string_view bytes) {
  const std::size_t size = bytes_of(type_);
  while (!left_.empty() && !bytes.empty()) {
    left_ += bytes.front();
    bytes.remove_prefix(1);
    if (left_.size() < size) continue;
    convert(left_.data(), 1);
    left_.clear();
  }
  while (bytes.size() >= size) {
    const std::size_t count = std::min(bytes.size() / size, kPieceOfNumbers);
    convert(bytes.data(), count);
    bytes.remove_prefix(count * size);
  }
  left_ += bytes;
}

}  // namespace odobench
