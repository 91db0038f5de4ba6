// Axes of trajectories: which of the file's axes span the ground.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "datasets/logs/tables/table_layout.hpp"

namespace odobench {

// Ground axes x, y and up as axes (0, 1, 2) of the file with a sign: a rotation, so that the vector part of a
// quaternion turns the same way.
struct GroundPlane {
  std::string name;
  std::array<std::size_t, 3> axis;
  std::array<double, 3> sign;
};

// "xy" (z up), "zx" (y up), "xz" (camera: z forward, y down). Throws std::invalid_argument for others.
GroundPlane ground_plane(const std::string& name);

// Fields x, y, z of three columns in file axes, in `metres` per unit of the file.
void add_position(std::vector<TableField>& fields, const GroundPlane& plane,
                  const std::array<std::size_t, 3>& columns, double metres);
// Fields qx, qy, qz, qw and heading of four columns x, y, z, w.
void add_quaternion(std::vector<TableField>& fields, const GroundPlane& plane,
                    const std::array<std::size_t, 4>& columns);

// Heading in this plane of a body with rotation matrix R (file axes, row by row).
double heading_of_matrix(const GroundPlane& plane, const std::array<double, 9>& r);
double heading_of_quaternion(double x, double y, double z, double w);

// Rotation by three angles [rad] about the axes named "XYZ", "ZYX", ...: the first one outermost.
std::array<double, 9> matrix_of_angles(const std::string& order, const double* angles);

}  // namespace odobench
