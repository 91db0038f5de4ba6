// UMBmark (Borenstein, Feng, IEEE T-RA 12(6):869-880, 1996) and the correction by headings of Jung and Chung
// (ICRA 2012): squares driven in both senses, of which only the ends count.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "base/angle.hpp"
#include "problems/calibration/classical/methods.hpp"

namespace odobench::classical {
namespace {

using Eigen::Index;

// A square turns once, mostly at its corners, and its end lies near its start.
constexpr double kClosed = 0.25;       // of the side
constexpr double kPathOfSides = 0.15;  // of 4 sides: all squares are alike, or as given
constexpr double kOnce = 0.15;         // of a turn
constexpr double kSquareness = 0.5;

// |mean of exp(4 i heading)| along the path by odometry: 1 for four directions at right angles, 0 for a
// circle.
double squareness(const Drive& drive) {
  double c = 0, s = 0, length = 0;
  for (Index k = 1; k < drive.odometry.cols(); ++k) {
    const double step = (drive.odometry.col(k) - drive.odometry.col(k - 1)).head<2>().norm();
    const double heading = 2 * (drive.odometry(2, k) + drive.odometry(2, k - 1));
    c += step * std::cos(heading);
    s += step * std::sin(heading);
    length += step;
  }
  return length > 0 ? std::hypot(c, s) / length : 0;
}

// Given, or a quarter of the path by odometry, which is what a robot goes by that drives a square by itself.
double side_of(const Drives& drives) {
  if (drives.options().side > 0) return drives.options().side;
  double sum = 0;
  for (const Drive& drive : drives.list()) sum += drive.path() / 4;
  return sum / static_cast<double>(drives.list().size());
}

Matrix end_errors(const Drives& drives, int sense, const Vector& z) {
  const std::vector<const Drive*> list = drives.of_sense(sense);
  Matrix errors(3, static_cast<Index>(list.size()));
  for (Index i = 0; i < errors.cols(); ++i)
    errors.col(i) = drives.end_error(*list[static_cast<std::size_t>(i)], z);
  return errors;
}

// Standard deviation of positions about their mean; not-a-number for one.
double spread(const Matrix& errors) {
  if (errors.cols() < 2) return std::numeric_limits<double>::quiet_NaN();
  const Matrix positions = errors.topRows(2);
  return std::sqrt((positions.colwise() - positions.rowwise().mean()).squaredNorm() /
                   static_cast<double>(errors.cols() - 1));
}

struct Corner {
  double alpha = 0;  // rad: of every corner, by the track
  double beta = 0;   // rad: of every side, by the radii
};

// Both methods end alike: from the angles to the numbers.
Result corrected(const Drives& drives, const Corner& corner, double beta, std::vector<Figure> figures) {
  const double side = side_of(drives), track = drives.nominal("b");
  const double right = drives.nominal("r_right"), left = drives.nominal("r_left");
  const double sine = std::sin(beta / 2), track_factor = (kPi / 2) / (kPi / 2 - corner.alpha);
  const double new_track = track_factor * track;
  // (R + b/2) / (R - b/2) with R = (L/2) / sin(beta/2), which is infinite for wheels that agree.
  const double lever = (drives.options().nominal_track ? track : new_track) * sine;
  const double ratio = (side + lever) / (side - lever), mean = (right + left) / 2;
  Result result;
  result.z = drives.nominal();
  result.z[drives.position("b")] = new_track;
  result.z[drives.position("r_right")] = 2 * mean / (1 / ratio + 1);
  result.z[drives.position("r_left")] = 2 * mean / (ratio + 1);
  result.figures = std::move(figures);
  result.figures.insert(
      result.figures.end(),
      {{"R", "m", side / 2 / sine}, {"Eb", "1", track_factor}, {"Ed", "1", ratio}, {"side", "m", side}});
  double before = 0, after = 0;
  for (const int sense : {-1, 1}) {
    const char* name = sense < 0 ? "cw" : "ccw";
    const Matrix errors = end_errors(drives, sense, drives.nominal());
    const Eigen::Vector3d centre = errors.rowwise().mean();
    const double r = centre.head<2>().norm();
    const double r_after = end_errors(drives, sense, result.z).rowwise().mean().head<2>().norm();
    before = std::max(before, r);
    after = std::max(after, r_after);
    result.figures.insert(result.figures.end(), {{fmt::format("x_{}", name), "m", centre[0]},
                                                 {fmt::format("y_{}", name), "m", centre[1]},
                                                 {fmt::format("r_{}", name), "m", r},
                                                 {fmt::format("r_{}_after", name), "m", r_after},
                                                 {fmt::format("spread_{}", name), "m", spread(errors)}});
  }
  result.figures.push_back({"E_max_syst", "m", before});
  result.figures.push_back({"E_max_syst_after", "m", after});
  return result;
}

Result umbmark(const Drives& drives, bool by_x) {
  const double quarter = -4 * side_of(drives);
  const Eigen::Vector3d cw = end_errors(drives, -1, drives.nominal()).rowwise().mean();
  const Eigen::Vector3d ccw = end_errors(drives, 1, drives.nominal()).rowwise().mean();
  const Corner corner = by_x ? Corner{(cw[0] + ccw[0]) / quarter, (cw[0] - ccw[0]) / quarter}
                             : Corner{(cw[1] - ccw[1]) / quarter, (cw[1] + ccw[1]) / quarter};
  return corrected(drives, corner, corner.beta,
                   {{"alpha", "rad", corner.alpha}, {"beta", "rad", corner.beta}});
}

double circular_mean(const Matrix& errors) {
  return std::atan2(errors.row(2).array().sin().sum(), errors.row(2).array().cos().sum());
}

Result by_headings(const Drives& drives, bool divided_again) {
  double theta[2];
  for (const int sense : {-1, 1}) {
    const Matrix errors = end_errors(drives, sense, drives.nominal());
    theta[sense > 0 ? 1 : 0] =
        circular_mean(errors) / (divided_again ? static_cast<double>(errors.cols()) : 1);
  }
  const double alpha_b = (theta[0] - theta[1]) / 8, beta_d = (theta[0] + theta[1]) / 8;
  const double alpha_d = kPi * drives.nominal("b") * beta_d / (4 * side_of(drives));
  return corrected(drives, {alpha_b + alpha_d, beta_d}, beta_d,
                   {{"theta_cw", "rad", theta[0]},
                    {"theta_ccw", "rad", theta[1]},
                    {"alpha_b", "rad", alpha_b},
                    {"beta_d", "rad", beta_d},
                    {"alpha_d", "rad", alpha_d}});
}

}  // namespace

std::string why_no_squares(const Drives& drives) {
  for (const Drive& drive : drives.list()) {
    const double turns = std::abs(drive.turned()) / (2 * kPi);
    if (std::abs(turns - 1) > kOnce)
      return fmt::format("recording {} turns {:.2f} times, expected once as in a square", drive.id, turns);
    if (squareness(drive) < kSquareness)
      return fmt::format("recording {} does not follow four directions at right angles, expected a square",
                         drive.id);
  }
  const double side = side_of(drives);
  for (const Drive& drive : drives.list()) {
    const double path = drive.path(), apart = drive.end().head<2>().norm();
    if (std::abs(path - 4 * side) > kPathOfSides * 4 * side)
      return fmt::format(
          "the path of recording {} is {:.2f} m long, expected about {:.2f} m: a square of {:.2f} m",
          drive.id, path, 4 * side, side);
    if (apart > kClosed * side)
      return fmt::format("recording {} ends {:.2f} m from its start, expected a closed square", drive.id,
                         apart);
  }
  const std::size_t least = std::max<std::size_t>(drives.options().least_runs, 1);
  for (const int sense : {-1, 1}) {
    const std::size_t count = drives.of_sense(sense).size();
    if (count < least)
      return fmt::format("{} of the squares are driven {}, expected at least {} in each sense", count,
                         sense < 0 ? "clockwise" : "counter-clockwise", least);
  }
  return "";
}

Result umbmark_x(const Drives& drives) {
  return umbmark(drives, true);
}
Result umbmark_y(const Drives& drives) {
  return umbmark(drives, false);
}
Result jung_chung(const Drives& drives) {
  return by_headings(drives, false);
}
Result jung_chung_of_optiodom(const Drives& drives) {
  return by_headings(drives, true);
}

}  // namespace odobench::classical
