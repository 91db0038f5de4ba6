// Arrays of numbers with names (MAT and NumPy files) as a log: the reader of a format walks over its arrays
// and gives their bytes piece by piece, this makes sources and columns of them. No array is ever in memory as
// a whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/logs/log_file.hpp"

namespace odobench {

enum class NumberType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Int64, Uint64, Single, Double, Bool };

std::size_t bytes_of(NumberType type);
const char* name_of(NumberType type);  // "int64", "float64"

// Classes of MATLAB: double (6), single (7), int8 to uint64 (8 to 15).
bool is_number_of_matlab(unsigned class_number);
NumberType number_type_of_matlab(unsigned class_number);

// Structs joined by dots: "ticks.count", "log.signals.values".
struct ArrayHead {
  std::string name;
  NumberType type = NumberType::Double;  // what it is shown as
  std::size_t rows = 0, columns = 1;     // of a vector of either direction: 1 column
  bool by_rows = false;                  // the numbers come row by row (C), else column by column (Fortran)
};

// rows and columns of dimensions: trailing ones are columns, a vector has one column. False where the product
// overflows or has more than 2^40 numbers, or there are more than 10,000 columns.
bool shape_of(const std::vector<std::uint64_t>& dimensions, ArrayHead& head);

// Gets arrays one after the other.
class ArrayVisitor {
 public:
  virtual ~ArrayVisitor() = default;
  // False: its numbers are not wanted.
  virtual bool begin(const ArrayHead& head) = 0;
  // The next numbers of the array: whole ones or reals, the other pointer is null.
  virtual void numbers(const std::int64_t* whole, const double* real, std::size_t count) = 0;
  // An array that cannot be read, and why.
  virtual void skip(const std::string& name, const std::string& reason) = 0;
};

// Makes numbers of bytes in pieces of any length.
class ArrayBytes {
 public:
  // `type` as stored, which may be smaller than the array's.
  ArrayBytes(ArrayVisitor& visitor, NumberType type, bool big_endian = false)
      : visitor_(visitor), type_(type), swap_(big_endian) {}
  void take(std::string_view bytes);

 private:
  void convert(const char* bytes, std::size_t count);

  ArrayVisitor& visitor_;
  NumberType type_;
  bool swap_;
  std::string left_;  // of a number cut in two
  std::vector<std::int64_t> whole_;
  std::vector<double> real_;
};

// How arrays are grouped: MAT: "ticks.count" is field count of source ticks; npz: by names of times, see
// npz_log_format().
enum class ArrayGrouping { Structs, TimePrefixes };

// Walks over all arrays of the file; DataError where it is damaged.
using ArrayWalk = std::function<void(ArrayVisitor& visitor, const Stop& stop)>;

// Time of a source: its first vector whose name tells time ("t", "stamp_ns", "time") and whose unit is in its
// name or can be told from its numbers, else the first vector that does by its numbers; int64 is exact.
std::unique_ptr<LogFile> open_arrays(const std::filesystem::path& file, std::string format,
                                     ArrayGrouping grouping, ArrayWalk walk);

}  // namespace odobench
