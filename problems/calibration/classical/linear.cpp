// Methods that are one or two linear least-squares problems: Kallasi's of the tricycle, Lin's of
// omnidirectional robots, Antonelli's of the differential robot.
#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

#include "problems/calibration/classical/methods.hpp"
#include "problems/robots/integration.hpp"

namespace odobench::classical {
namespace {

using Eigen::Index;

// Least squares of full rank.
Vector solved(const Matrix& a, const Vector& b, const char* unknowns) {
  const Eigen::ColPivHouseholderQR<Matrix> qr(a);
  if (qr.rank() < a.cols())
    throw std::invalid_argument(fmt::format("the drives do not determine {}", unknowns));
  return qr.solve(b);
}

// The shortest solution where the rank is not full: wheels of a mecanum robot that never slip agree.
Vector shortest(const Matrix& a, const Vector& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}

// Sample rows of all drives but their starts.
Index piece_count(const Drives& drives) {
  Index count = 0;
  for (const Drive& drive : drives.list()) count += static_cast<Index>(drive.rows.size()) - 1;
  return count;
}

// Calls visit(drive, entry of the reference, interval after it) for them.
template <class Visit>
void for_each_sample_row(const Drives& drives, Visit visit) {
  for (const Drive& drive : drives.list())
    for (std::size_t i = 1; i < drive.rows.size(); ++i)
      visit(drive, static_cast<Index>(drive.rows[i]), static_cast<Index>(drive.stamps[drive.rows[i]]));
}

// Sums of the columns before each: column k is what the first k intervals add up to.
Matrix sums_before(const Matrix& m) {
  Matrix sums = Matrix::Zero(m.rows(), m.cols() + 1);
  for (Index k = 0; k < m.cols(); ++k) sums.col(k + 1) = sums.col(k) + m.col(k);
  return sums;
}

// Headings at the sample rows as a linear function of the wheels' sums.
Vector heading_coefficients(const Drives& drives, const Vector& scale) {
  const Index wheels = scale.size();
  Matrix a(piece_count(drives), wheels);
  Vector b(a.rows());
  Index row = 0;
  const Drive* last = nullptr;
  Matrix sums;
  for_each_sample_row(drives, [&](const Drive& drive, Index entry, Index stamp) {
    if (&drive != last) sums = sums_before(scale.asDiagonal() * drive.signals);
    last = &drive;
    a.row(row) = sums.col(stamp).transpose();
    b[row++] = drive.measured(2, entry);
  });
  return wheels == 4 ? shortest(a, b) : solved(a, b, "headings by wheels");
}

// Positions at the sample rows as a linear function of k: the motions (3 x intervals, one matrix per unknown)
// turned by `headings` of the intervals and added up.
template <class Parts>
Vector position_coefficients(const Drives& drives, Index unknowns, Parts parts) {
  Matrix a(2 * piece_count(drives), unknowns);
  Vector b(a.rows());
  Index row = 0;
  for (const Drive& drive : drives.list()) {
    std::vector<Matrix> sums;  // 2 x (intervals + 1) per unknown
    for (const Matrix& part : parts(drive)) sums.push_back(sums_before(part));
    for (std::size_t i = 1; i < drive.rows.size(); ++i, row += 2) {
      const auto stamp = static_cast<Index>(drive.stamps[drive.rows[i]]);
      for (Index u = 0; u < unknowns; ++u)
        a.block<2, 1>(row, u) = sums[static_cast<std::size_t>(u)].col(stamp);
      b.segment<2>(row) = drive.measured.col(static_cast<Index>(drive.rows[i])).head<2>();
    }
  }
  return solved(a, b, "positions by wheels");
}

// Motions turned by an angle per interval.
Matrix turned_by(const Vector& angles, const Matrix& motions) {
  Matrix turned(2, motions.cols());
  turned.row(0) = angles.array().cos().transpose() * motions.row(0).array() -
                  angles.array().sin().transpose() * motions.row(1).array();
  turned.row(1) = angles.array().sin().transpose() * motions.row(0).array() +
                  angles.array().cos().transpose() * motions.row(1).array();
  return turned;
}

}  // namespace

std::string why_no_pieces(const Drives& drives) {
  const Index pieces = piece_count(drives), expected = drives.nominal().size() + 1;
  if (pieces >= expected) return "";
  return fmt::format("the recordings have {} sample rows at {:g} m, expected at least {}", pieces,
                     drives.options().distance, expected);
}

std::string why_no_turning(const Drives& drives) {
  std::string reason = why_no_pieces(drives);
  if (!reason.empty()) return reason;
  constexpr double kLeastTurn = 0.5;  // rad
  double most = 0;
  for (const Drive& drive : drives.list()) most = std::max(most, drive.measured.row(2).cwiseAbs().maxCoeff());
  if (most >= kLeastTurn) return "";
  return fmt::format("the recordings turn by at most {:.2f} rad, expected at least {} rad", most, kLeastTurn);
}

Result kallasi(const Drives& drives) {
  Matrix a(piece_count(drives), 2);
  Vector b(a.rows());
  Index row = 0;
  for (const Drive& drive : drives.list()) {
    Matrix parts(2, drive.signals.cols());
    parts.row(0) = drive.signals.row(0).array() * drive.signals.row(1).array().sin();
    parts.row(1) = drive.signals.row(0).array() * drive.signals.row(1).array().cos();
    const Matrix sums = sums_before(parts);
    for (std::size_t i = 1; i < drive.rows.size(); ++i, ++row) {
      const std::size_t from = drive.rows[i - 1], to = drive.rows[i];
      a.row(row) =
          (sums.col(static_cast<Index>(drive.stamps[to])) - sums.col(static_cast<Index>(drive.stamps[from])))
              .transpose();
      b[row] = drive.measured(2, static_cast<Index>(to)) - drive.measured(2, static_cast<Index>(from));
    }
  }
  const Vector p = solved(a, b, "the steering's zero");
  Result result;
  result.z = drives.nominal();
  result.z[drives.position("r")] = drives.nominal("wheelbase") * p.norm();
  result.z[drives.position("steering_zero")] = std::atan2(p[1], p[0]);
  result.figures = {{"P1", "1", p[0]}, {"P2", "1", p[1]}};
  return result;
}

Result lin(const Drives& drives) {
  const Index wheels = drives.list().front().signals.rows();
  Vector radii(wheels);
  for (Index i = 0; i < wheels; ++i) radii[i] = drives.nominal(fmt::format("r{}", i + 1));
  // Which way a wheel's path moves the body: x and y of the twist by a wheel, up to one magnitude each.
  Matrix pattern(2, wheels);
  if (wheels == 3)
    pattern << std::sqrt(3.0), -std::sqrt(3.0), 0, 1, 1, 1;
  else
    pattern << 1, 1, 1, 1, -1, 1, 1, -1;
  const Vector heading = heading_coefficients(drives, radii);
  const Vector k = position_coefficients(drives, wheels, [&](const Drive& drive) {
    const Matrix paths = radii.asDiagonal() * drive.signals;
    const Vector theta = sums_before(heading.transpose() * paths).row(0).tail(paths.cols()).transpose();
    std::vector<Matrix> parts;
    for (Index i = 0; i < wheels; ++i) parts.push_back(turned_by(theta, pattern.col(i) * paths.row(i)));
    return parts;
  });
  Result result;
  result.matrix.resize(3, wheels);
  result.matrix.topRows(2) = pattern * k.asDiagonal();
  result.matrix.row(2) = heading.transpose();
  return result;
}

std::vector<Matrix> tracks_by_matrix(const Matrix& matrix, const Robot& robot,
                                     const std::vector<Recording>& recordings, robots::IntegrationRule rule) {
  const Drives drives(robot, recordings, {});
  std::vector<Matrix> tracks;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const Drive& drive = drives.list()[i];
    if (matrix.rows() != 3 || matrix.cols() != drive.signals.rows())
      throw std::invalid_argument(fmt::format("a matrix of {} x {}, expected 3 x {}", matrix.rows(),
                                              matrix.cols(), drive.signals.rows()));
    Vector radii(matrix.cols());
    for (Index w = 0; w < radii.size(); ++w) radii[w] = drives.nominal(fmt::format("r{}", w + 1));
    const Reference& reference = recordings[i].reference;
    const bool at_start = reference.sample.empty() || reference.sample[0] == 0;
    const Eigen::Vector3d start = at_start
                                      ? Eigen::Vector3d(reference.x[0], reference.y[0], reference.theta[0])
                                      : Eigen::Vector3d::Zero();
    Matrix poses(3, drive.signals.cols() + 1);
    robots::integrate(rule, matrix * radii.asDiagonal() * drive.signals, start, poses, drive.seconds);
    tracks.push_back(std::move(poses));
  }
  return tracks;
}

Result antonelli(const Drives& drives) {
  const Vector c = heading_coefficients(drives, Vector::Ones(2));
  const Vector a = position_coefficients(drives, 2, [&](const Drive& drive) {
    const Matrix change = c.transpose() * drive.signals;
    const Matrix before = sums_before(change);
    std::vector<Matrix> parts;
    const Vector middle = (before.leftCols(change.cols()) + change / 2).transpose();
    for (Index wheel = 0; wheel < 2; ++wheel) {
      Matrix motions = Matrix::Zero(2, change.cols());
      for (Index i = 0; i < change.cols(); ++i)
        motions(0, i) = robots::sine_quotient(change(0, i) / 2) * drive.signals(wheel, i);
      parts.push_back(turned_by(middle, motions));
    }
    return parts;
  });
  Result result;
  result.z = drives.nominal();
  result.z[drives.position("b")] = 2 * (a[0] + a[1]) / (c[0] - c[1]);
  result.z[drives.position("r_right")] = 2 * a[0];
  result.z[drives.position("r_left")] = 2 * a[1];
  result.figures = {{"a_right", "m", a[0]},
                    {"a_left", "m", a[1]},
                    {"C_right", "1", c[0]},
                    {"C_left", "1", c[1]},
                    {"b_right", "m", 2 * a[0] / c[0]},
                    {"b_left", "m", -2 * a[1] / c[1]}};
  return result;
}

}  // namespace odobench::classical
