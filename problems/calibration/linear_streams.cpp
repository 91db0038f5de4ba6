#include "problems/calibration/linear_streams.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/range.hpp"

namespace odobench {
namespace {

using Eigen::Index;
using robots::IntegrationRule;

// As the kernels take M.
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr long kStepsOfSegment = 256;
constexpr Index kRowsAtOnce = 512;

}  // namespace

kernel::StepRule step_rule(IntegrationRule rule) {
  if (rule == IntegrationRule::Euler) return kernel::StepRule::Euler;
  return rule == IntegrationRule::Midpoint ? kernel::StepRule::Midpoint : kernel::StepRule::Arc;
}

bool LinearStreams::serves(IntegrationRule rule, Index streams) {
  return rule != IntegrationRule::OptiodomOmni && streams >= 1 && streams <= kernel::kMostStreams;
}

LinearStreams::LinearStreams(const Matrix& nominal, IntegrationRule rule, InstructionSet set)
    : kernel_(kernel::select(set)),
      rule_(step_rule(rule)),
      streams_(nominal.cols()),
      origin_(nominal.row(2).transpose()),
      rows_(Matrix::Zero(kRowsAtOnce, nominal.cols() + 1)),
      largest_(Vector::Zero(nominal.cols())) {}

void LinearStreams::add(const Matrix& streams, const Eigen::Vector3d& start, const Matrix& reference) {
  largest_ = largest_.cwiseMax(streams.cwiseAbs().rowwise().maxCoeff());
  // Rows (F, F h0 - turned) of the heading's sum of squares; sums have more digits than the factor.
  using Long = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  const Long origin = origin_.cast<long double>();
  Long f = Long::Zero(streams_);
  for (Index k = 0; k < streams.cols(); ++k) {
    f += streams.col(k).cast<long double>();
    const long double turned = static_cast<long double>(reference(2, k)) - static_cast<long double>(start[2]);
    if (filled_ == kRowsAtOnce) reduce();
    rows_.row(filled_++) << f.transpose().cast<double>(), static_cast<double>(f.dot(origin) - turned);
  }

  const auto intervals = static_cast<long>(streams.cols());
  const long width = kernel_.width;
  const long blocks = std::max(1L, intervals / (width * kStepsOfSegment));
  const long steps = intervals / (width * blocks);
  Drive drive;
  drive.start = start;
  Index next = 0;
  Vector turned = Vector::Zero(streams_);
  if (steps > 0)
    for (long b = 0; b < blocks; ++b)
      add_block(streams, start, reference, kernel_.width, steps, next, turned, drive);
  if (next < streams.cols())
    add_block(streams, start, reference, 1, static_cast<long>(streams.cols() - next), next, turned, drive);
  drives_.push_back(std::move(drive));
}

void LinearStreams::add_block(const Matrix& streams, const Eigen::Vector3d& start, const Matrix& reference,
                              int width, long steps, Index& next, Vector& turned, Drive& drive) {
  const auto row_size = static_cast<std::size_t>(streams_ + 2);
  const Block block{width, steps, data_.size(), drive.segments.size()};
  data_.resize(data_.size() + static_cast<std::size_t>(steps * width) * row_size);
  for (int lane = 0; lane < width; ++lane) {
    const double x = next == 0 ? start[0] : reference(0, next - 1);
    const double y = next == 0 ? start[1] : reference(1, next - 1);
    drive.segments.push_back({steps, turned, x, y});
    for (long k = 0; k < steps; ++k, ++next) {
      double* row = &data_[block.data + static_cast<std::size_t>(k * width) * row_size +
                           static_cast<std::size_t>(lane)];
      for (Index j = 0; j < streams_; ++j) row[j * width] = streams(j, next);
      row[streams_ * width] = reference(0, next) - x;
      row[(streams_ + 1) * width] = reference(1, next) - y;
      turned += streams.col(next);
    }
  }
  drive.blocks.push_back(block);
}

// Replaces the rows by their triangular factor.
void LinearStreams::reduce() {
  const Eigen::HouseholderQR<Matrix> qr(rows_.topRows(std::max(filled_, rows_.cols())));
  const Matrix factor = qr.matrixQR().topRows(rows_.cols()).triangularView<Eigen::Upper>();
  rows_.setZero();
  rows_.topRows(rows_.cols()) = factor;
  filled_ = rows_.cols();
}

void LinearStreams::finish() {
  reduce();
  rows_.conservativeResize(rows_.cols(), Eigen::NoChange);
}

void LinearStreams::begin_lanes(const Drive& drive, const Block& block, const Vector& h,
                                kernel::CostSums& sums) const {
  for (int lane = 0; lane < block.width; ++lane) {
    const Segment& segment = drive.segments[block.segment + static_cast<std::size_t>(lane)];
    const double theta = drive.start[2] + segment.turned.dot(h);
    sums.cos0[lane] = std::cos(theta);
    sums.sin0[lane] = std::sin(theta);
  }
}

kernel::StreamBlock LinearStreams::kernel_block(const Block& block) const {
  return {&data_[block.data], block.steps, static_cast<int>(streams_), rule_};
}

bool LinearStreams::turns_little(const Vector& h) const {
  // Written so that numbers that are none go the same way.
  return h.cwiseAbs().dot(largest_) <= kernel::kMaxAngle;
}

Vector LinearStreams::heading_residual(const Vector& h) const {
  return rows_.topLeftCorner(streams_, streams_).triangularView<Eigen::Upper>() * (h - origin_) +
         rows_.col(streams_).head(streams_);
}

double LinearStreams::joined_cost(double positions, const Vector& residual, double position,
                                  double heading) const {
  const double rest = rows_(streams_, streams_);
  return std::max(0.0, position * positions) + heading * (residual.squaredNorm() + rest * rest);
}

double LinearStreams::drive_cost(const Drive& drive, const double* m, const Vector& h) const {
  double x = drive.start[0], y = drive.start[1], cost = 0;
  kernel::CostSums sums;
  for (const Block& block : drive.blocks) {
    const Segment* segments = &drive.segments[block.segment];
    begin_lanes(drive, block, h, sums);
    (block.width == 1 ? kernel_.streams_tail : kernel_.streams)(kernel_block(block), m, sums);
    for (int lane = 0; lane < block.width; ++lane) {
      const double ex = x - segments[lane].x, ey = y - segments[lane].y;
      cost += sums.squares[lane] + 2 * (ex * sums.ex[lane] + ey * sums.ey[lane]) +
              static_cast<double>(block.steps) * (ex * ex + ey * ey);
      x += sums.x[lane];
      y += sums.y[lane];
    }
  }
  return cost;
}

double LinearStreams::cost(const Matrix& m, double position, double heading) const {
  const Vector h = m.row(2).transpose();
  if (!turns_little(h)) return kNotANumber;
  const RowMajor rows = m;
  double positions = 0;
  for (const Drive& drive : drives_) positions += drive_cost(drive, rows.data(), h);
  return joined_cost(positions, heading_residual(h), position, heading);
}

void LinearStreams::add_drive(const Drive& drive, const double* m, const Vector& h, const Matrix& heading_by,
                              const kernel::StreamDerivatives& by, NormalTotals& totals) const {
  totals.start(drive.start[0], drive.start[1]);
  kernel::NormalSums sums;
  double x[kernel::kMaxWidth], y[kernel::kMaxWidth];
  for (const Block& block : drive.blocks) {
    begin_lanes(drive, block, h, sums.cost);
    for (int lane = 0; lane < block.width; ++lane) {
      const Segment& segment = drive.segments[block.segment + static_cast<std::size_t>(lane)];
      x[lane] = segment.x;
      y[lane] = segment.y;
      const Vector turned_by = heading_by * segment.turned;
      for (int p = 0; p < by.columns; ++p) sums.heading0[p][lane] = turned_by[p];
    }
    (block.width == 1 ? kernel_.streams_normal_tail : kernel_.streams_normal)(kernel_block(block), m, by,
                                                                              sums);
    totals.add(sums, block.width, block.steps, x, y);
  }
}

bool LinearStreams::normal_equations(const Matrix& m, const std::vector<Matrix>& by, double position,
                                     double heading, NormalEquations& out) const {
  const Vector h = m.row(2).transpose();
  const auto n = static_cast<Index>(by.size());
  if (!turns_little(h) || n > kernel::kMostColumns) return false;
  const RowMajor rows = m;
  RowMajor derivatives(3 * n, streams_);
  Matrix heading_by(n, streams_);
  for (Index p = 0; p < n; ++p) {
    derivatives.middleRows<3>(3 * p) = by[static_cast<std::size_t>(p)];
    heading_by.row(p) = derivatives.row(3 * p + 2);
  }
  NormalTotals totals(static_cast<int>(n));
  for (const Drive& drive : drives_)
    add_drive(drive, rows.data(), h, heading_by, {derivatives.data(), static_cast<int>(n)}, totals);
  const Vector residual = heading_residual(h);
  const Matrix r = rows_.topLeftCorner(streams_, streams_).triangularView<Eigen::Upper>();
  const Matrix turned_by = r * heading_by.transpose();  // S x n
  out.cost = joined_cost(totals.cost(), residual, position, heading);
  out.jtr = position * totals.jtr() + heading * (turned_by.transpose() * residual);
  out.jtj = position * totals.jtj();
  out.jtj.selfadjointView<Eigen::Lower>().rankUpdate(turned_by.transpose(), heading);
  out.jtj.triangularView<Eigen::StrictlyUpper>() = out.jtj.transpose();
  return true;
}

}  // namespace odobench
