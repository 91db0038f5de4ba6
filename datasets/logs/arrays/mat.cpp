#include "datasets/logs/arrays/mat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/logs/arrays/array_log.hpp"
#include "datasets/logs/arrays/byte_source.hpp"
#include "datasets/logs/arrays/npy_array.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeaderBytes = 128, kDeepestStruct = 16, kMostDimensionsOfMat = 32;
constexpr std::uint32_t kMatrix = 14, kCompressed = 15;  // types of elements
constexpr std::uint64_t kLongestNames = 1 << 20, kMostStructs = 65'536;

// Classes of matrices.
constexpr std::uint32_t kStruct = 2, kOpaque = 17;

std::string reason_of_class(std::uint32_t number, const std::string& kind, const std::string& name) {
  if (number == kOpaque)
    return fmt::format(
        "a {} of MATLAB, which no other program can read: "
        "s = table2struct({},'ToScalar',true); save('log.mat','-struct','s','-v7')",
        kind.empty() ? "table or object" : shown(kind), name.empty() ? "T" : shown(name));
  constexpr std::array<const char*, 6> names{"unknown", "cell array", "struct",
                                             "object",  "text",       "sparse matrix"};
  return fmt::format("a {} of MATLAB, expected numbers", number < names.size() ? names[number] : "value");
}

std::optional<NumberType> type_of_element(std::uint32_t type) {
  switch (type) {
    case 1:
      return NumberType::Int8;
    case 2:
      return NumberType::Uint8;
    case 3:
      return NumberType::Int16;
    case 4:
      return NumberType::Uint16;
    case 5:
      return NumberType::Int32;
    case 6:
      return NumberType::Uint32;
    case 7:
      return NumberType::Single;
    case 9:
      return NumberType::Double;
    case 12:
      return NumberType::Int64;
    case 13:
      return NumberType::Uint64;
    default:
      return std::nullopt;
  }
}

struct Element {
  std::uint32_t type = 0;
  std::uint64_t size = 0, padding = 0;
};

// One variable: the elements of a matrix, front to back.
class MatVariable {
 public:
  MatVariable(ByteSource& bytes, std::string file, bool swap, ArrayVisitor& visitor, const Stop& stop)
      : bytes_(bytes), file_(std::move(file)), swap_(swap), visitor_(visitor), stop_(stop) {}

  // The tag of an element; nothing where the source ends before one.
  std::optional<Element> take_tag() {
    char tag[8];
    small_size_ = 0;
    const std::size_t n = bytes_.read(tag, 1);
    if (n == 0) return std::nullopt;
    if (!bytes_.read_exactly(tag + 1, 7)) fail("the tag of an element is cut off");
    const std::uint32_t word = number(tag), size = number(tag + 4);
    if (word >> 16 == 0) return Element{word, size, (8 - size % 8) % 8};
    small_size_ = word >> 16;
    if (small_size_ > 4)
      fail(fmt::format("found a small element of {} bytes, expected at most 4", small_size_));
    std::memcpy(small_, tag + 4, 4);
    return Element{word & 0xFFFF, small_size_, 0};
  }
  // A matrix whose tag has been taken.
  void take_matrix(std::uint64_t size, const std::string& prefix, std::size_t depth);

 private:
  [[noreturn]] void fail(const std::string& message) const { throw DataError(file_ + ": " + message); }

  std::uint32_t number(const char* at) const {
    std::uint32_t value = 0;
    std::memcpy(&value, at, sizeof value);
    return swap_ ? __builtin_bswap32(value) : value;
  }
  Element take_element(std::uint64_t& left) {
    if (left < 8) fail("a matrix ends inside an element");
    const std::optional<Element> element = take_tag();
    if (!element) fail("a matrix is cut off");
    left -= 8;
    if (small_size_ > 0) return *element;
    if (element->size > left)
      fail(fmt::format("an element claims {} bytes, its matrix has {} left", element->size, left));
    left -= std::min(left, element->size + element->padding);
    return *element;
  }
  // The bytes of the element whose tag was taken last.
  std::string take_bytes(const Element& element, std::uint64_t most, const char* what) {
    if (element.size > most)
      fail(fmt::format("found {} of {} bytes, expected at most {}", what, element.size, most));
    if (small_size_ > 0 || element.size == 0) return {small_, static_cast<std::size_t>(element.size)};
    std::string bytes(static_cast<std::size_t>(element.size), '\0');
    if (!bytes_.read_exactly(bytes.data(), bytes.size())) fail(fmt::format("{} is cut off", what));
    bytes_.skip(element.padding);
    return bytes;
  }
  std::vector<std::uint64_t> take_dimensions(std::uint64_t& left);
  void take_numbers(std::uint64_t& left, const std::string& name, std::uint32_t class_number, bool logical,
                    const std::vector<std::uint64_t>& dimensions);
  void take_struct(std::uint64_t& left, const std::string& name, const std::vector<std::uint64_t>& dimensions,
                   std::size_t depth);
  void take_opaque(std::uint64_t& left, const std::string& prefix);

  ByteSource& bytes_;
  std::string file_;
  bool swap_;
  ArrayVisitor& visitor_;
  const Stop& stop_;
  char small_[4] = {};
  std::size_t small_size_ = 0;
};

std::vector<std::uint64_t> MatVariable::take_dimensions(std::uint64_t& left) {
  const std::string bytes = take_bytes(take_element(left), 4 * kMostDimensionsOfMat, "dimensions");
  std::vector<std::uint64_t> dimensions;
  for (std::size_t at = 0; at + 4 <= bytes.size(); at += 4) {
    const auto n = static_cast<std::int32_t>(number(bytes.data() + at));
    if (n < 0) fail(fmt::format("found a dimension of {}", n));
    dimensions.push_back(static_cast<std::uint64_t>(n));
  }
  if (dimensions.size() < 2) fail("found a matrix without two dimensions");
  return dimensions;
}

void MatVariable::take_matrix(std::uint64_t size, const std::string& prefix, std::size_t depth) {
  std::uint64_t left = size;
  if (left == 0) return;  // an empty field
  const std::string flags = take_bytes(take_element(left), 8, "flags of a matrix");
  if (flags.size() != 8) fail("found no flags of a matrix");
  const std::uint32_t word = number(flags.data()), class_number = word & 0xFF;
  constexpr std::uint32_t logical = 0x200;
  if (class_number == kOpaque) {
    take_opaque(left, prefix);
  } else {
    const std::vector<std::uint64_t> dimensions = take_dimensions(left);
    const std::string own = take_bytes(take_element(left), 4096, "a name");
    const std::string name = prefix.empty() ? own : prefix;
    const bool numbers = is_number_of_matlab(class_number);
    if (name.empty()) {
      // Behind the last variable MATLAB puts data of its own without a name.
    } else if (class_number == kStruct) {
      take_struct(left, name, dimensions, depth);
    } else if (numbers) {
      take_numbers(left, name, class_number, (word & logical) != 0, dimensions);
    } else {
      visitor_.skip(name, reason_of_class(class_number, "", name));
    }
  }
  bytes_.skip(left);
}

// Its elements are the name, the type system ("MCOS") and the class ("table").
void MatVariable::take_opaque(std::uint64_t& left, const std::string& prefix) {
  std::array<std::string, 3> texts;
  for (std::string& text : texts) text = take_bytes(take_element(left), 4096, "a name");
  const std::string& name = prefix.empty() ? texts[0] : prefix;
  visitor_.skip(name, reason_of_class(kOpaque, texts[2], name));
}

void MatVariable::take_struct(std::uint64_t& left, const std::string& name,
                              const std::vector<std::uint64_t>& dimensions, std::size_t depth) {
  if (depth >= kDeepestStruct) fail(fmt::format("found structs nested deeper than {}", kDeepestStruct));
  const std::string length_bytes = take_bytes(take_element(left), 4, "a length of names");
  const std::uint32_t length = length_bytes.size() == 4 ? number(length_bytes.data()) : 0;
  const std::string names = take_bytes(take_element(left), kLongestNames, "names of fields");
  if (length == 0 || names.size() % length != 0)
    fail(fmt::format("found no names of the fields of {}", shown(name)));
  std::uint64_t count = 1;
  for (const std::uint64_t n : dimensions)
    if (__builtin_mul_overflow(count, n, &count) || count > kMostStructs)
      fail(fmt::format("found more than {} structs in {}", kMostStructs, shown(name)));
  for (std::uint64_t k = 0; k < count; ++k)
    for (std::size_t at = 0; at < names.size(); at += length) {
      const std::string padded = names.substr(at, length);
      const std::string field = padded.substr(0, padded.find('\0'));
      const Element element = take_element(left);
      if (element.type != kMatrix)
        fail(fmt::format("found an element of type {} in {}", element.type, shown(name)));
      take_matrix(element.size, fmt::format("{}{}.{}", name, count == 1 ? "" : fmt::format("[{}]", k), field),
                  depth + 1);
      bytes_.skip(element.padding);
    }
}

void MatVariable::take_numbers(std::uint64_t& left, const std::string& name, std::uint32_t class_number,
                               bool logical, const std::vector<std::uint64_t>& dimensions) {
  ArrayHead head;
  head.name = name;
  head.type = logical ? NumberType::Bool : number_type_of_matlab(class_number);
  if (!shape_of(dimensions, head)) {
    visitor_.skip(name, "its dimensions are too large");
    return;
  }
  const Element element = take_element(left);
  const bool small = small_size_ > 0;
  const std::optional<NumberType> stored = type_of_element(element.type);
  if (!stored) fail(fmt::format("{}: found numbers of type {}", shown(name), element.type));
  const std::uint64_t expected = std::uint64_t{head.rows} * head.columns * bytes_of(*stored);
  if (element.size != expected)
    fail(fmt::format("{}: found {} bytes of numbers, expected {} for its dimensions", shown(name),
                     element.size, expected));
  if (expected > kLargestArray)
    fail(fmt::format("{}: claims {} bytes, more than {}", shown(name), expected, kLargestArray));
  const bool wanted = visitor_.begin(head);
  if (small || !wanted) {
    if (wanted) ArrayBytes(visitor_, *stored, swap_).take({small_, static_cast<std::size_t>(element.size)});
    if (!small) bytes_.skip(element.size + element.padding);
    return;
  }
  ArrayBytes numbers(visitor_, *stored, swap_);
  std::vector<char> piece(1 << 16);
  for (std::uint64_t rest = expected; rest > 0;) {
    stop_.check();
    const std::size_t n =
        bytes_.read(piece.data(), static_cast<std::size_t>(std::min<std::uint64_t>(rest, piece.size())));
    if (n == 0) fail(fmt::format("{}: {} bytes are missing: the file is cut off", shown(name), rest));
    numbers.take({piece.data(), n});
    rest -= n;
  }
  bytes_.skip(element.padding);
}

void walk_mat(const fs::path& file, std::int64_t max_bytes, ArrayVisitor& visitor, const Stop& stop) {
  const std::string name = shown_path(file);
  FileBytes bytes(file);
  char header[kHeaderBytes];
  if (!bytes.read_exactly(header, sizeof header)) throw DataError(name + ": the header is cut off");
  auto left = static_cast<std::uint64_t>(max_bytes);  // bytes that may be decompressed
  const bool swap = header[126] == 'M';               // "MI" instead of "IM"
  while (bytes.position() < bytes.size()) {
    const std::uint64_t at = bytes.position();
    const std::string place = fmt::format("{}: variable at byte {}", name, at);
    MatVariable reader(bytes, place, swap, visitor, stop);
    const std::optional<Element> element = reader.take_tag();
    if (!element) return;
    const std::uint64_t begin = bytes.position();
    if (element->size > bytes.size() - begin)
      throw DataError(fmt::format("{}: byte {}: {} bytes expected, {} left: the file is cut off", name, begin,
                                  element->size, bytes.size() - begin));
    LimitedBytes part(bytes, element->size);
    if (element->type == kCompressed) {
      InflatedBytes inflated(part, false, std::min(left, kLargestArray), place);
      MatVariable variable(inflated, place, swap, visitor, stop);
      const std::optional<Element> matrix = variable.take_tag();
      if (!matrix || matrix->type != kMatrix)
        throw DataError(place + ": found no matrix in the compressed data");
      variable.take_matrix(matrix->size, "", 0);
      left -= std::min(left, matrix->size);
    } else if (element->type == kMatrix) {
      MatVariable(part, place, swap, visitor, stop).take_matrix(element->size, "", 0);
    } else {
      throw DataError(
          fmt::format("{}: found an element of type {}, expected a matrix", place, element->type));
    }
    bytes.seek(begin + element->size);
  }
}

bool is_mat(const fs::path&, const std::string& head) {
  if (head.size() < kHeaderBytes) return false;
  const std::string end = head.substr(124, 4);
  return end == std::string("\x00\x01IM", 4) || end == std::string("\x01\x00MI", 4);
}

std::unique_ptr<LogFile> open_mat(const fs::path& file, const LogOptions& options) {
  return open_arrays(file, "MAT v5", ArrayGrouping::Structs,
                     [file, most = options.max_bytes](ArrayVisitor& visitor, const Stop& stop) {
                       walk_mat(file, most, visitor, stop);
                     });
}

}  // namespace

LogFormat mat_log_format() {
  return {"MAT v5", is_mat, open_mat};
}

}  // namespace odobench
