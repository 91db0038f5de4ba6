#include "datasets/logs/arrays/npy_array.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>

#include "base/text.hpp"

namespace odobench {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kLongestNpyHeader = 1 << 16, kMostDimensions = 32;

// What stands behind 'key': in the header's dict.
std::string_view value_of(std::string_view header, std::string_view key) {
  for (const char quote : {'\'', '"'}) {
    const std::string quoted = fmt::format("{}{}{}", quote, key, quote);
    const std::size_t at = header.find(quoted);
    if (at == std::string_view::npos) continue;
    const std::size_t begin = header.find_first_not_of(" :", at + quoted.size());
    return begin == std::string_view::npos ? std::string_view() : header.substr(begin);
  }
  return {};
}

std::optional<std::vector<std::uint64_t>> dimensions_of(std::string_view text) {
  if (text.empty() || text.front() != '(') return std::nullopt;
  std::vector<std::uint64_t> dimensions;
  for (text.remove_prefix(1);;) {
    while (!text.empty() && (text.front() == ' ' || text.front() == ',')) text.remove_prefix(1);
    if (!text.empty() && text.front() == ')') return dimensions;
    std::uint64_t n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc() || dimensions.size() >= kMostDimensions) return std::nullopt;
    dimensions.push_back(n);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
}

struct NpyType {
  NumberType type = NumberType::Double;
  bool big_endian = false;
  std::string refusal;
};

NpyType type_of_descr(std::string_view text) {
  NpyType result;
  if (!text.empty() && text.front() == '[') {
    result.refusal = "an array of records: save each of its fields as an array of numbers";
    return result;
  }
  const char quote = text.empty() ? ' ' : text.front();
  const std::string_view descr =
      text.empty() ? text : text.substr(1, std::min(text.find(quote, 1), text.size()) - 1);
  const std::string_view kind = descr.empty() ? descr : descr.substr(1);
  result.big_endian = !descr.empty() && descr.front() == '>';
  constexpr std::array<std::string_view, 11> kinds{"i1", "u1", "i2", "u2", "i4", "u4",
                                                   "i8", "u8", "f4", "f8", "b1"};
  for (std::size_t k = 0; k < kinds.size(); ++k)
    if (kind == kinds[k] && std::string_view("<>|=").find(descr.front()) != std::string_view::npos) {
      result.type = static_cast<NumberType>(k);
      return result;
    }
  result.refusal = kind.substr(0, 1) == "O"
                       ? "object array: save numbers"
                       : fmt::format("an array of type {}, expected integers, floats or bool", shown(descr));
  return result;
}

std::string read_header(ByteSource& bytes, const std::string& place) {
  const auto cut = [&] { return DataError(place + ": the header of the array is cut off"); };
  unsigned char begin[8], length[4] = {};
  if (!bytes.read_exactly(reinterpret_cast<char*>(begin), sizeof begin)) throw cut();
  if (std::string_view(reinterpret_cast<char*>(begin), kMagic.size()) != kMagic || begin[6] < 1 ||
      begin[6] > 3)
    throw DataError(place + ": found no array of NumPy, expected one of version 1 to 3");
  if (!bytes.read_exactly(reinterpret_cast<char*>(length), begin[6] == 1 ? 2 : 4)) throw cut();
  const std::size_t size = length[0] | static_cast<std::size_t>(length[1]) << 8 |
                           static_cast<std::size_t>(length[2]) << 16 |
                           static_cast<std::size_t>(length[3]) << 24;
  if (size > kLongestNpyHeader)
    throw DataError(
        fmt::format("{}: found a header of {} bytes, expected at most {}", place, size, kLongestNpyHeader));
  std::string header(size, ' ');
  if (!bytes.read_exactly(header.data(), size)) throw cut();
  return header;
}

}  // namespace

bool walk_npy(ByteSource& bytes, const std::string& name, const std::string& place, ArrayVisitor& visitor,
              const Stop& stop) {
  const std::string header = read_header(bytes, place);
  const NpyType type = type_of_descr(value_of(header, "descr"));
  if (!type.refusal.empty()) {
    visitor.skip(name, type.refusal);
    return false;
  }
  const auto dimensions = dimensions_of(value_of(header, "shape"));
  ArrayHead head;
  head.name = name;
  head.type = type.type;
  if (!dimensions || !shape_of(*dimensions, head))
    throw DataError(fmt::format("{}: found a shape that is none or too large: {}", place,
                                shown(value_of(header, "shape"))));
  head.by_rows = value_of(header, "fortran_order").substr(0, 4) != "True";
  std::uint64_t left = std::uint64_t{head.rows} * head.columns * bytes_of(type.type);
  if (left > kLargestArray)
    throw DataError(fmt::format("{}: claims {} bytes, more than {}", place, left, kLargestArray));
  if (!visitor.begin(head)) return false;
  ArrayBytes numbers(visitor, type.type, type.big_endian);
  std::vector<char> piece(1 << 16);
  while (left > 0) {
    stop.check();
    const std::size_t n =
        bytes.read(piece.data(), static_cast<std::size_t>(std::min<std::uint64_t>(left, piece.size())));
    if (n == 0) throw DataError(fmt::format("{}: {} bytes are missing: the array is cut off", place, left));
    numbers.take({piece.data(), n});
    left -= n;
  }
  return true;
}

}  // namespace odobench
