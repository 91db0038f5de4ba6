// Circles in both senses, and Ivanjko's straight lines and half turns.
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"
#include "problems/calibration/classical/methods.hpp"

namespace odobench::classical {
namespace {

using Eigen::Index;

constexpr double kRoundness = 0.15;  // of the length of a circular path
constexpr double kStraight = 0.1;    // of the path: how far a line may end from where its path would lead
constexpr double kOnTheSpot = 0.1;   // of the track per rad

double largest_extent(const Drive& drive) {
  return drive.extent().maxCoeff();
}

// Ends of straight lines and their derivatives by the factors of right and left radius.
struct LineEnds {
  Vector errors;  // odometry minus measured, x and y
  Matrix by;      // 2 columns
};

// x, y and heading of the end for right and left wheel angles, by the midpoint or another rule, with
// derivatives by both factors: a factor acts on the angles.
LineEnds line_ends(const Drives& drives, const std::vector<const Drive*>& lines, const Vector& z,
                   const Eigen::Vector2d& factors) {
  const double b = z[drives.position("b")];
  const Eigen::Vector2d r(z[drives.position("r_right")], z[drives.position("r_left")]);
  LineEnds ends{Vector(2 * static_cast<Index>(lines.size())),
                Matrix(2 * static_cast<Index>(lines.size()), 2)};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Drive& drive = *lines[i];
    const auto last = static_cast<Index>(drive.stamps.back());
    const Index n = drive.signals.cols();
    Matrix motions(3, n), motions_by = Matrix::Zero(3 * n, 2), poses(3, n + 1), by(3 * (n + 1), 2);
    const Matrix paths = r.asDiagonal() * drive.signals;
    motions = unit_track_motions(paths, factors[0], factors[1]);
    motions.row(2) /= b;
    for (Index k = 0; k < n; ++k) {
      motions_by.row(3 * k) << paths(0, k) / 2, paths(1, k) / 2;
      motions_by.row(3 * k + 2) << paths(0, k) / b, -paths(1, k) / b;
    }
    robots::integrate(drives.options().rule, motions, motions_by, Eigen::Vector3d::Zero(), poses, by,
                      drive.seconds);
    const auto row = 2 * static_cast<Index>(i);
    ends.errors.segment<2>(row) = poses.col(last).head<2>() - drive.end().head<2>();
    ends.by.middleRows(row, 2) = by.middleRows(3 * last, 2);
  }
  return ends;
}

// Factors of right and left radius that bring the ends of straight lines nearest to the measured ones
// (Gauss-Newton: the residuals are small).
Eigen::Vector2d radius_factors(const Drives& drives, const std::vector<const Drive*>& lines,
                               const Vector& z) {
  constexpr int kMostSteps = 50;
  constexpr double kSmallStep = 1e-14;
  Eigen::Vector2d factors(1, 1);
  for (int step = 0; step < kMostSteps; ++step) {
    const LineEnds ends = line_ends(drives, lines, z, factors);
    const Eigen::Matrix2d normal = ends.by.transpose() * ends.by;
    const Eigen::Vector2d change = normal.inverse() * (ends.by.transpose() * ends.errors);
    if (!change.allFinite())
      throw std::invalid_argument("the straight lines do not determine both radii, expected lines that move");
    factors -= change;
    if (change.norm() < kSmallStep) break;
  }
  return factors;
}

// The factor of the track that brings the headings at the ends nearest to the measured ones: they go with 1 /
// b.
double track_factor(const Drives& drives, const std::vector<const Drive*>& turns, const Vector& z) {
  double both = 0, own = 0;
  for (const Drive* drive : turns) {
    const Matrix poses = drives.odometry(*drive, z, drives.options().rule);
    const double reckoned = poses(2, static_cast<Index>(drive->stamps.back()));
    both += reckoned * (reckoned + wrapped_angle(drive->end()[2] - reckoned));
    own += reckoned * reckoned;
  }
  return own / both;
}

}  // namespace

std::string why_no_circles(const Drives& drives) {
  for (const Drive& drive : drives.list()) {
    const double round = std::abs(drive.turned()) * largest_extent(drive) / 2, path = drive.path();
    if (drive.sense == 0)
      return fmt::format("recording {} turns by {:.0f} degrees, expected a circle of at least half a turn",
                         drive.id, drive.turned() / kDegree);
    if (std::abs(path - round) > kRoundness * round)
      return fmt::format("the path of recording {} is {:.2f} m long, expected about {:.2f} m as of a circle",
                         drive.id, path, round);
  }
  for (const int sense : {-1, 1})
    if (drives.of_sense(sense).empty())
      return fmt::format("no circle is driven {}, expected both senses",
                         sense < 0 ? "clockwise" : "counter-clockwise");
  return "";
}

Result circles(const Drives& drives) {
  Eigen::Matrix2d angles;
  Eigen::Vector2d turns;
  for (const int sense : {-1, 1}) {
    const std::vector<const Drive*> list = drives.of_sense(sense);
    const Index row = sense > 0 ? 1 : 0;
    angles.row(row).setZero();
    turns[row] = 0;
    for (const Drive* drive : list) {
      const auto count = static_cast<double>(list.size());
      angles.row(row) +=
          drive->signals.leftCols(static_cast<Index>(drive->stamps.back())).rowwise().sum().transpose() /
          count;
      turns[row] += drive->end()[2] / count;
    }
  }
  const Eigen::Vector2d c = angles.fullPivLu().solve(turns);  // r_right / b, -r_left / b
  double measured = 0, own = 0;
  for (const Drive& drive : drives.list()) {
    Matrix poses(3, drive.signals.cols() + 1);
    robots::integrate(robots::IntegrationRule::Arc, unit_track_motions(drive.signals, c[0], -c[1]),
                      Eigen::Vector3d::Zero(), poses);
    const Eigen::Vector2d p = poses.col(static_cast<Index>(drive.stamps.back())).head<2>();
    measured += p.dot(drive.end().head<2>());
    own += p.squaredNorm();
  }
  const double b = measured / own;
  Result result;
  result.z = drives.nominal();
  result.z[drives.position("b")] = b;
  result.z[drives.position("r_right")] = b * c[0];
  result.z[drives.position("r_left")] = -b * c[1];
  result.figures = {{"C_right", "1", c[0]},
                    {"C_left", "1", c[1]},
                    {"turn_cw", "rad", turns[0]},
                    {"turn_ccw", "rad", turns[1]}};
  return result;
}

std::string why_no_lines_and_turns(const Drives& drives) {
  const double b = drives.nominal("b");
  for (const Drive& drive : drives.list()) {
    const double far = drive.end().head<2>().norm(), path = drive.path();
    if (drive.sense == 0 && std::abs(path - far) > kStraight * path)
      return fmt::format(
          "recording {} ends {:.2f} m from its start after {:.2f} m, expected a straight line or a "
          "turn on the spot",
          drive.id, far, path);
    if (drive.sense != 0 && path > kOnTheSpot * b * std::abs(drive.turned()))
      return fmt::format("recording {} turns along a path of {:.2f} m, expected a turn on the spot", drive.id,
                         path);
  }
  if (drives.of_sense(0).empty()) return "no recording is a straight line, expected at least one";
  for (const int sense : {-1, 1})
    if (drives.of_sense(sense).empty())
      return fmt::format("no recording turns {} on the spot, expected both senses",
                         sense < 0 ? "clockwise" : "counter-clockwise");
  return "";
}

Result ivanjko(const Drives& drives) {
  constexpr double kNearOne = 1e-3;
  constexpr int kMostRounds = 100;
  const std::vector<const Drive*> lines = drives.of_sense(0), cw = drives.of_sense(-1),
                                  ccw = drives.of_sense(1);
  Vector z = drives.nominal();
  Result result;
  for (int round = 1; round <= kMostRounds; ++round) {
    const Eigen::Vector2d radii = radius_factors(drives, lines, z);
    z[drives.position("r_right")] *= radii[0];
    z[drives.position("r_left")] *= radii[1];
    const double k_cw = track_factor(drives, cw, z), k_ccw = track_factor(drives, ccw, z);
    const double k = (k_cw + k_ccw) / 2;
    z[drives.position("b")] *= k;
    result.figures = {{"rounds", "1", static_cast<double>(round)},
                      {"k_right", "1", radii[0]},
                      {"k_left", "1", radii[1]},
                      {"k_cw", "1", k_cw},
                      {"k_ccw", "1", k_ccw}};
    if (std::abs(radii[0] - 1) < kNearOne && std::abs(radii[1] - 1) < kNearOne &&
        std::abs(k - 1) < kNearOne) {
      result.z = z;
      return result;
    }
  }
  throw std::invalid_argument(fmt::format("the factors do not settle within {} rounds", kMostRounds));
}

}  // namespace odobench::classical
