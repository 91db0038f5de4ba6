#include "problems/calibration/structure.hpp"

#include "datasets/robot_4wis4wid.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace odobench {
namespace {

using kernel::kHeading;
using kernel::kLinear;
using kernel::kStreams;

// Steps of a segment: long enough to amortise its start, short enough for a block to stay in the second-level
// cache.
constexpr long kSegmentSteps = 256;

// (C_1..C_4, S_1..S_4), one column per increment. Steering that stays keeps its sine and cosine.
Increments increments_of(const Recording& recording) {
  Increments list(kHeading, static_cast<Eigen::Index>(recording.size()) - 1);
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    const std::vector<double>&speed = wheel_speed_of(recording, i), &steering = steering_of(recording, i);
    const auto row = static_cast<Eigen::Index>(i);
    double last = std::numeric_limits<double>::quiet_NaN(), c = 0, s = 0;
    for (Eigen::Index column = 0; column < list.cols(); ++column) {
      const auto k = static_cast<std::size_t>(column);
      const double dt = static_cast<double>(recording.time_us[k + 1] - recording.time_us[k]) * 1e-6;
      if (steering[k] != last) {
        last = steering[k];
        c = std::cos(last);
        s = std::sin(last);
      }
      const double turn = 0.25 * dt * speed[k];
      list(row, column) = turn * c;
      list(row + 4, column) = turn * s;
    }
  }
  return list;
}

// dtheta/d(P, Q) of an increment: (-C, S).
HeadingVector heading_increment(const HeadingVector& cs) {
  HeadingVector f = cs;
  f.head<4>() = -f.head<4>();
  return f;
}

// Collects the rows (F, F h0 - turned) of HeadingForm. The sums over a recording have more digits than the
// factor.
class HeadingSums {
 public:
  explicit HeadingSums(const HeadingVector& origin) : origin_(origin.cast<long double>()) { rows_.setZero(); }

  void add(const Recording& recording, const Increments& list) {
    Eigen::Matrix<long double, kHeading, 1> f = decltype(f)::Zero();
    for (Eigen::Index k = 0; k < list.cols(); ++k) {
      f += heading_increment(list.col(k)).cast<long double>();
      const long double turned =
          static_cast<long double>(recording.reference.theta[static_cast<std::size_t>(k) + 1]) -
          static_cast<long double>(recording.reference.theta[0]);
      if (filled_ == kRows) reduce();
      rows_.row(filled_++) << f.transpose().cast<double>(), static_cast<double>(f.dot(origin_) - turned);
    }
  }

  HeadingForm form() {
    reduce();
    const HeadingMatrix r = rows_.topLeftCorner<kHeading, kHeading>();
    HeadingForm form;
    form.origin = origin_.cast<double>();
    form.r = r;
    form.q = rows_.col(kHeading).head<kHeading>();
    form.a = r.transpose() * r;
    form.rest = rows_(kHeading, kHeading) * rows_(kHeading, kHeading);
    return form;
  }

 private:
  static constexpr Eigen::Index kColumns = kHeading + 1, kRows = 512;
  using Rows = Eigen::Matrix<double, kRows, kColumns>;

  // Replaces the rows by their triangular factor.
  void reduce() {
    const Eigen::HouseholderQR<Rows> qr(rows_);
    const Rows factor = qr.matrixQR().triangularView<Eigen::Upper>();
    rows_.setZero();
    rows_.topRows<kColumns>() = factor.topRows<kColumns>();
    filled_ = kColumns;
  }

  Eigen::Matrix<long double, kHeading, 1> origin_;
  Rows rows_;
  Eigen::Index filled_ = kColumns;
};

}  // namespace

LinearVector linear_parameters(const ConstVectorRef& z) {
  LinearVector s;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double a = z[i], b = z[4 + i], r = z[8 + i], d = a * a + b * b;
    s[i] = r;
    s[4 + i] = r * b / d;
    s[8 + i] = r * a / d;
  }
  return s;
}

LinearMatrix linear_jacobian(const ConstVectorRef& z) {
  LinearMatrix j = LinearMatrix::Zero();
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double a = z[i], b = z[4 + i], r = z[8 + i], d = a * a + b * b;
    j(i, 8 + i) = 1;
    j(4 + i, i) = -2 * a * b * r / (d * d);
    j(4 + i, 4 + i) = r * (a * a - b * b) / (d * d);
    j(4 + i, 8 + i) = b / d;
    j(8 + i, i) = r * (b * b - a * a) / (d * d);
    j(8 + i, 4 + i) = -2 * a * b * r / (d * d);
    j(8 + i, 8 + i) = a / d;
  }
  return j;
}

CalibrationStructure::CalibrationStructure(const std::vector<Recording>& recordings,
                                           const ConstVectorRef& nominal, InstructionSet kernel)
    : kernel_(kernel::select(kernel)) {
  HeadingSums heading(linear_parameters(nominal).tail<kHeading>());
  std::size_t samples = 0;
  for (const Recording& recording : recordings) samples += recording.size() - 1;
  data_.reserve(samples * kStreams);
  for (const Recording& recording : recordings) {
    const Increments steps = increments_of(recording);
    largest_step_ = largest_step_.cwiseMax(steps.cwiseAbs().rowwise().maxCoeff());
    plan_recording(recording, steps);
    heading.add(recording, steps);
  }
  heading_ = heading.form();
  squares_.finish();
}

void CalibrationStructure::plan_recording(const Recording& recording, const Increments& list) {
  const auto increments = static_cast<long>(list.cols());
  const int w = kernel_.width;
  const long block_count = std::max(1L, increments / (w * kSegmentSteps));
  const long steps = increments / (w * block_count);
  RecordingPlan plan;
  plan.theta0 = recording.reference.theta[0];
  long next = 0;
  // Plain numbers: vectors of Eigen would be stored in halves and loaded whole, which stalls.
  double heading[kHeading] = {};
  const auto add_block = [&](int width, long length) {
    BlockPlan block{width, length, data_.size(), plan.segments.size()};
    data_.resize(data_.size() + static_cast<std::size_t>(length * kStreams * width));
    for (int lane = 0; lane < width; ++lane) {
      const auto first = static_cast<std::size_t>(next);
      plan.segments.push_back({length, Eigen::Map<const HeadingVector>(heading), recording.reference.x[first],
                               recording.reference.y[first]});
      for (long k = 0; k < length; ++k, ++next) {
        const auto sample = static_cast<std::size_t>(next);
        const double* cs = list.data() + next * kHeading;
        double* row = &data_[block.data + static_cast<std::size_t>(k * kStreams * width + lane)];
        for (int j = 0; j < kHeading; ++j) row[j * width] = cs[j];
        row[8 * width] = recording.reference.x[sample + 1] - recording.reference.x[first];
        row[9 * width] = recording.reference.y[sample + 1] - recording.reference.y[first];
        if ((length - k) % 2 == 1) squares_.add(cs, heading);
        for (int j = 0; j < kHeading; ++j) heading[j] += j < 4 ? -cs[j] : cs[j];
      }
    }
    plan.blocks.push_back(block);
  };
  if (steps > 0)
    for (long b = 0; b < block_count; ++b) add_block(w, steps);
  if (next < increments) add_block(1, increments - next);
  plans_.push_back(std::move(plan));
}

bool CalibrationStructure::needs_exact_rotation(const LinearVector& s) const {
  // Written so that NaN parameters take the exact form too.
  return !(s.tail<kHeading>().cwiseAbs().dot(largest_step_) <= kernel::kMaxAngle);
}

HeadingVector CalibrationStructure::heading_residual(const LinearVector& s) const {
  return heading_.r.triangularView<Eigen::Upper>() * HeadingVector(s.tail<kHeading>() - heading_.origin) +
         heading_.q;
}

double CalibrationStructure::heading_cost(const LinearVector& s) const {
  return heading_residual(s).squaredNorm() + heading_.rest;
}

double CalibrationStructure::recording_cost(const RecordingPlan& plan, const LinearVector& s,
                                            bool exact) const {
  double x = 0, y = 0, cost = 0;
  kernel::CostSums sums;
  for (const BlockPlan& block : plan.blocks) {
    for (int lane = 0; lane < block.width; ++lane) {
      const Segment& segment = plan.segments[block.segment + static_cast<std::size_t>(lane)];
      const double theta = plan.theta0 + segment.heading0.dot(s.tail<kHeading>());
      sums.cos0[lane] = std::cos(theta);
      sums.sin0[lane] = std::sin(theta);
    }
    (block.width == 1 ? kernel_.cost_tail : kernel_.cost)({&data_[block.data], block.steps}, s.data(), exact,
                                                          sums);
    for (int lane = 0; lane < block.width; ++lane) {
      const Segment& segment = plan.segments[block.segment + static_cast<std::size_t>(lane)];
      // The error at the segment's start is added to every sample of it: sum (e + e0)^2 = sum e^2 + 2 e0 sum
      // e + n e0^2.
      const double ex0 = x - segment.x_ref, ey0 = y - segment.y_ref;
      cost += sums.squares[lane] + 2 * (ex0 * sums.ex[lane] + ey0 * sums.ey[lane]) +
              static_cast<double>(segment.steps) * (ex0 * ex0 + ey0 * ey0);
      x += sums.x[lane];
      y += sums.y[lane];
    }
  }
  return cost;
}

double CalibrationStructure::cost(const ConstVectorRef& z) const {
  const LinearVector s = linear_parameters(z);
  const bool exact = needs_exact_rotation(s);
  double sum = heading_cost(s);
  for (const RecordingPlan& plan : plans_) sum += recording_cost(plan, s, exact);
  return sum;
}

void CalibrationStructure::batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const {
  // Recording by recording, so that its blocks stay in the cache for all candidates. The order of the
  // additions is that of cost(): a candidate's value is the same bits alone and in any batch.
  std::vector<LinearVector> s;
  std::vector<char> exact;
  for (Eigen::Index k = 0; k < candidates.cols(); ++k) {
    s.push_back(linear_parameters(candidates.col(k)));
    exact.push_back(needs_exact_rotation(s.back()));
    costs[k] = heading_cost(s.back());
  }
  for (const RecordingPlan& plan : plans_)
    for (std::size_t k = 0; k < s.size(); ++k)
      costs[static_cast<Eigen::Index>(k)] += recording_cost(plan, s[k], exact[k] != 0);
}

void CalibrationStructure::add_normal(const RecordingPlan& plan, const LinearVector& s, bool exact,
                                      NormalTotals& totals) const {
  totals.start(0, 0);
  kernel::NormalSums sums;
  double reference_x[kernel::kMaxWidth], reference_y[kernel::kMaxWidth];
  for (const BlockPlan& block : plan.blocks) {
    for (int lane = 0; lane < block.width; ++lane) {
      const Segment& segment = plan.segments[block.segment + static_cast<std::size_t>(lane)];
      const double theta = plan.theta0 + segment.heading0.dot(s.tail<kHeading>());
      sums.cost.cos0[lane] = std::cos(theta);
      sums.cost.sin0[lane] = std::sin(theta);
      for (int j = 0; j < kLinear - kHeading; ++j) sums.heading0[j][lane] = 0;
      for (int j = 0; j < kHeading; ++j) sums.heading0[kLinear - kHeading + j][lane] = segment.heading0[j];
      reference_x[lane] = segment.x_ref;
      reference_y[lane] = segment.y_ref;
    }
    (block.width == 1 ? kernel_.normal_tail : kernel_.normal)({&data_[block.data], block.steps}, s.data(),
                                                              exact, sums);
    totals.add(sums, block.width, block.steps, reference_x, reference_y);
  }
}

void CalibrationStructure::normal_equations(const ConstVectorRef& z, NormalEquations& out) const {
  const LinearVector s = linear_parameters(z);
  const bool exact = needs_exact_rotation(s);
  NormalTotals totals(kLinear, heading_cost(s));
  for (const RecordingPlan& plan : plans_) add_normal(plan, s, exact, totals);
  LinearVector jtr = totals.jtr();
  LinearMatrix jtj = LinearMatrix(totals.jtj()) + 0.5 * squares_.at(s);
  jtr.tail<kHeading>() += heading_.r.transpose().triangularView<Eigen::Lower>() * heading_residual(s);
  jtj.bottomRightCorner<kHeading, kHeading>() += heading_.a;
  const LinearMatrix d = linear_jacobian(z);
  out.cost = totals.cost();
  out.jtr = d.transpose() * jtr;
  const LinearMatrix full = d.transpose() * jtj * d;
  out.jtj = 0.5 * (full + full.transpose());
}

}  // namespace odobench
