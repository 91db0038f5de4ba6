#include "datasets/logs/tables/ground_plane.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "base/text.hpp"

namespace odobench {
namespace {

TableField signed_column(const std::string& name, std::size_t column, double factor) {
  TableField field{{name, "number", ""}, {column}, {}};
  if (factor != 1) field.value = [factor](const double* value) { return factor * value[0]; };
  return field;
}

std::array<double, 9> product(const std::array<double, 9>& a, const std::array<double, 9>& b) {
  std::array<double, 9> c{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
  return c;
}

}  // namespace

GroundPlane ground_plane(const std::string& name) {
  if (name == "xy") return {name, {0, 1, 2}, {1, 1, 1}};
  if (name == "zx") return {name, {2, 0, 1}, {1, 1, 1}};
  if (name == "xz") return {name, {2, 0, 1}, {1, -1, -1}};
  throw std::invalid_argument(fmt::format("plane: found '{}', expected xy, zx or xz", shown(name)));
}

void add_position(std::vector<TableField>& fields, const GroundPlane& plane,
                  const std::array<std::size_t, 3>& columns, double metres) {
  constexpr std::array<const char*, 3> names{"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i)
    fields.push_back(signed_column(names[i], columns[plane.axis[i]], plane.sign[i] * metres));
}

void add_quaternion(std::vector<TableField>& fields, const GroundPlane& plane,
                    const std::array<std::size_t, 4>& columns) {
  constexpr std::array<const char*, 3> names{"qx", "qy", "qz"};
  for (std::size_t i = 0; i < 3; ++i)
    fields.push_back(signed_column(names[i], columns[plane.axis[i]], plane.sign[i]));
  fields.push_back(signed_column("qw", columns[3], 1));
  const std::array<double, 3> s = plane.sign;
  fields.push_back(
      {{"heading", "number", ""},
       {columns[plane.axis[0]], columns[plane.axis[1]], columns[plane.axis[2]], columns[3]},
       [s](const double* q) { return heading_of_quaternion(s[0] * q[0], s[1] * q[1], s[2] * q[2], q[3]); }});
}

double heading_of_matrix(const GroundPlane& plane, const std::array<double, 9>& r) {
  const std::size_t x = plane.axis[0], y = plane.axis[1];
  return std::atan2(plane.sign[1] * r[3 * y + x], r[3 * x + x]);
}

double heading_of_quaternion(double x, double y, double z, double w) {
  return std::atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z);
}

std::array<double, 9> matrix_of_angles(const std::string& order, const double* angles) {
  std::array<double, 9> r{1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(order[k] - 'X');
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<double, 9> turn{};
    turn[4 * axis] = 1;
    turn[4 * u] = turn[4 * v] = std::cos(angles[k]);
    turn[3 * v + u] = std::sin(angles[k]);
    turn[3 * u + v] = -std::sin(angles[k]);
    r = product(r, turn);
  }
  return r;
}

}  // namespace odobench
