// Odometry and sensor pose at once (Censi, Franchi, Marchionni, Oriolo, IEEE T-RO 29(2), 2013), piece by
// piece.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

#include "problems/calibration/classical/methods.hpp"
#include "problems/calibration/classical/sensor_mount.hpp"
#include "problems/robots/integration.hpp"

namespace odobench::classical {
namespace {

using Eigen::Index;

// A piece of a drive: what the sensor saw, and how the robot moved with a track of 1.
struct Piece {
  Eigen::Vector3d sensor;
  Eigen::Vector2d moved;
};

struct Pieces {
  Eigen::Vector2d c;  // r_right / b, -r_left / b
  std::vector<Piece> list;
};

Pieces pieces_of(const Drives& drives) {
  std::vector<Eigen::Vector2d> angles;
  std::vector<double> turns;
  for (const Drive& drive : drives.list())
    for (std::size_t i = 1; i < drive.rows.size(); ++i) {
      const auto from = static_cast<Index>(drive.stamps[drive.rows[i - 1]]),
                 to = static_cast<Index>(drive.stamps[drive.rows[i]]);
      angles.push_back(drive.signals.middleCols(from, to - from).rowwise().sum());
      turns.push_back(drive.measured(2, static_cast<Index>(drive.rows[i])) -
                      drive.measured(2, static_cast<Index>(drive.rows[i - 1])));
    }
  Matrix a(static_cast<Index>(angles.size()), 2);
  for (Index row = 0; row < a.rows(); ++row) a.row(row) = angles[static_cast<std::size_t>(row)].transpose();
  const Eigen::ColPivHouseholderQR<Matrix> qr(a);
  if (qr.rank() < 2) throw std::invalid_argument("the pieces do not tell the wheels apart");
  Pieces pieces;
  pieces.c = qr.solve(Eigen::Map<const Vector>(turns.data(), a.rows()));
  for (const Drive& drive : drives.list())
    for (std::size_t i = 1; i < drive.rows.size(); ++i) {
      const auto from = static_cast<Index>(drive.stamps[drive.rows[i - 1]]),
                 to = static_cast<Index>(drive.stamps[drive.rows[i]]);
      Matrix poses(3, to - from + 1);
      robots::integrate(
          robots::IntegrationRule::Arc,
          unit_track_motions(drive.signals.middleCols(from, to - from), pieces.c[0], -pieces.c[1]),
          Eigen::Vector3d::Zero(), poses);
      pieces.list.push_back({relative(drive.measured.col(static_cast<Index>(drive.rows[i - 1])),
                                      drive.measured.col(static_cast<Index>(drive.rows[i]))),
                             poses.col(to - from).head<2>()});
    }
  return pieces;
}

Result result_of(const Drives& drives, const Pieces& pieces, double b) {
  Result result;
  result.z = drives.nominal();
  result.z[drives.position("b")] = b;
  result.z[drives.position("r_right")] = b * pieces.c[0];
  result.z[drives.position("r_left")] = -b * pieces.c[1];
  result.figures = {{"C_right", "1", pieces.c[0]},
                    {"C_left", "1", pieces.c[1]},
                    {"pieces", "1", static_cast<double>(pieces.list.size())}};
  return result;
}

// The constrained minimum over all pieces, with factor > 0.
struct Mounted {
  double factor = 1;  // of the robot's own motion
  Eigen::Vector3d mount;
  double smallest = 0, next = 0;  // eigenvalues
};

Mounted mounted(const std::vector<Piece>& pieces) {
  Eigen::Matrix<double, 5, 5> m = Eigen::Matrix<double, 5, 5>::Zero();
  for (const Piece& piece : pieces) {
    const double c = std::cos(piece.sensor[2]), s = std::sin(piece.sensor[2]);
    Eigen::Matrix<double, 2, 5> rows;
    rows << -piece.moved[0], 1 - c, s, piece.sensor[0], -piece.sensor[1],  //
        -piece.moved[1], -s, 1 - c, piece.sensor[1], piece.sensor[0];
    m += rows.transpose() * rows;
  }
  const Eigen::Matrix3d a = m.topLeftCorner<3, 3>();
  const Eigen::Matrix<double, 3, 2> across = m.topRightCorner<3, 2>();
  const Eigen::LDLT<Eigen::Matrix3d> factors(a);
  constexpr double kLeastShare = 1e-12;  // of the largest pivot
  const Eigen::Vector3d pivots = factors.vectorD();
  if (!(pivots.minCoeff() > kLeastShare * pivots.maxCoeff()))
    throw std::invalid_argument("all pieces have the same curvature, expected different ones");
  const Eigen::Matrix<double, 3, 2> solved = factors.solve(across);
  const Eigen::Matrix2d rest = m.bottomRightCorner<2, 2>() - across.transpose() * solved;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(rest);  // ascending, unit vectors
  Eigen::Vector2d u = eigen.eigenvectors().col(0);
  Eigen::Vector3d found = -solved * u;
  if (found[0] < 0) {
    found = -found;
    u = -u;
  }
  return {
      found[0], {found[1], found[2], std::atan2(u[1], u[0])}, eigen.eigenvalues()[0], eigen.eigenvalues()[1]};
}

}  // namespace

Result censi(const Drives& drives) {
  const Pieces pieces = pieces_of(drives);
  double measured = 0, own = 0;
  for (const Piece& piece : pieces.list) {
    measured += piece.moved.dot(piece.sensor.head<2>());
    own += piece.moved.squaredNorm();
  }
  if (!(own > 0)) throw std::invalid_argument("the robot moves in no piece");
  return result_of(drives, pieces, measured / own);
}

Result censi_with_mount(const Drives& drives) {
  const Pieces pieces = pieces_of(drives);
  const Mounted found = mounted(pieces.list);
  Result result = result_of(drives, pieces, found.factor);
  result.mount = found.mount;
  result.figures.push_back({"smallest", "m^2", found.smallest});
  result.figures.push_back({"next", "m^2", found.next});
  return result;
}

std::optional<Eigen::Vector3d> sensor_mount(const Robot& robot, const std::vector<Recording>& recordings,
                                            const Options& options) {
  try {
    const Drives drives(robot, recordings, options);
    if (!why_no_turning(drives).empty()) return std::nullopt;
    std::vector<Piece> pieces;
    for (const Drive& drive : drives.list())
      for (std::size_t i = 1; i < drive.rows.size(); ++i) {
        const std::size_t a = drive.rows[i - 1], b = drive.rows[i];
        pieces.push_back(
            {relative(drive.measured.col(static_cast<Index>(a)), drive.measured.col(static_cast<Index>(b))),
             relative(drive.odometry.col(static_cast<Index>(drive.stamps[a])),
                      drive.odometry.col(static_cast<Index>(drive.stamps[b])))
                 .head<2>()});
      }
    return mounted(pieces).mount;
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

}  // namespace odobench::classical
