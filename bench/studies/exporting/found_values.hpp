// Numbers of a calibration as other programs take them: text with a point, and where each comes from.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/studies/parameter_files.hpp"

namespace odobench {

// "0.050000": with a point whatever the value, never "-0.000000".
std::string decimal(double value, int digits);
// Metres and radians have 6 digits, ratios 9.
int digits_of(std::string_view unit);

struct FoundNumber {
  std::string name, unit;
  double value = 0, nominal = 0;
  std::optional<double> half_width;  // of the 95 % interval
  std::string at_bound = {};
  std::string decided_by = {};  // why there is no interval, in words
};
// "b 0.200123 m, nominal 0.200000, +- 0.000012"; that it lies on a bound.
std::string words_of(const FoundNumber& number);
// "nominal 0.200000, +- 0.000012 m" for what stands beside the value.
std::string remark_on(const FoundNumber& number);

// Of several wheels one number, and half the distance between the largest and the smallest.
struct MeanNumber {
  double mean = 0, nominal = 0, half_difference = 0;
};
MeanNumber mean_of(const std::vector<FoundNumber>& numbers);

class FoundValues {
 public:
  explicit FoundValues(const ParameterFile& file) : file_(file) {}
  // By name, ties resolved. DataError where the row has no such parameter.
  FoundNumber at(const std::string& name) const;
  bool has(const std::string& name) const;
  // name1, name2, ...
  std::vector<FoundNumber> numbered(const std::string& name) const;
  const ParameterFile& file() const { return file_; }

 private:
  const ParameterFile& file_;
};

// A name for each wheel, good in every language: front_left, ... where four stand round the origin, else that
// of its signal, wheel_2 without one.
std::vector<std::string> wheel_names(const ParameterFile& file);
// Front left, front right, rear left, rear right as indices; none where wheels are not one in each quadrant.
std::vector<std::size_t> quadrants(const ParameterFile& file);

// The mount of the tracked frame, where the calibration estimated it.
struct FoundMount {
  FoundNumber x, y, yaw;
};
std::optional<FoundMount> found_mount(const ParameterFile& file);

// What a file says of where it comes from, line by line, printable.
std::vector<std::string> origin_lines(const ParameterFile& file);
// Values on a bound of their box, a sentence each.
std::vector<std::string> bound_warnings(const ParameterFile& file);

}  // namespace odobench
