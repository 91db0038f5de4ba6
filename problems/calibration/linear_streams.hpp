// J over every sample of a robot whose motions are M(z) s, from streams s that do not depend on z: two
// multiplications a sample and stream instead of the robot's kinematics, several segments side by side in
// vector registers, and no sine.
//
// The heading part is a constant quadratic form in the third row h of M, kept as a sum of squares
// |R (h - h0) + q|^2 + rest like that of the thesis' robot (problems/calibration/structure.hpp). Positions
// are summed by segments of a drive, from exact headings where they begin; the errors of a segment are
// corrected for its start by sum (e + e0)^2 = sum e^2 + 2 e0 sum e + n e0^2.
#pragma once

#include <vector>

#include "problems/calibration/kernel/kernel.hpp"
#include "problems/calibration/normal_totals.hpp"
#include "problems/instruction_set.hpp"
#include "problems/problem.hpp"
#include "problems/robots/integration.hpp"

namespace odobench {

// What the kernels call euler, midpoint and arc.
kernel::StepRule step_rule(robots::IntegrationRule rule);

class LinearStreams {
 public:
  // No drives yet. `nominal`: M at the nominal parameters. Rules euler, midpoint and arc; at most
  // kernel::kMostStreams streams.
  LinearStreams(const Matrix& nominal, robots::IntegrationRule rule, InstructionSet kernel);
  static bool serves(robots::IntegrationRule rule, Eigen::Index streams);

  // streams: S x N; start and reference: poses x, y, theta, the reference 3 x N at the ends of the intervals.
  void add(const Matrix& streams, const Eigen::Vector3d& start, const Matrix& reference);
  // After the last drive.
  void finish();

  // position * (dx^2 + dy^2) + heading * dtheta^2, summed over all samples. Not-a-number where a step would
  // turn further than the kernel's series hold: then it is for the general form to say.
  double cost(const Matrix& m, double position, double heading) const;
  // The same and, with `by` the derivatives of M by the n parameters (3 x S each), J'r (n) and J'J (n x n)
  // of the residuals sqrt(position) (dx, dy), sqrt(heading) dtheta of all samples. False, and `out` as it
  // was, where the cost would be not-a-number, and for more than kernel::kMostColumns parameters.
  bool normal_equations(const Matrix& m, const std::vector<Matrix>& by, double position, double heading,
                        NormalEquations& out) const;

 private:
  struct Segment {
    long steps;
    Vector turned;  // sum of the streams up to its start
    double x, y;    // reference where it begins, m
  };
  struct Block {
    int width;
    long steps;
    std::size_t data, segment;  // where they begin
  };
  struct Drive {
    Eigen::Vector3d start;
    std::vector<Block> blocks;
    std::vector<Segment> segments;
  };
  void reduce();
  void add_block(const Matrix& streams, const Eigen::Vector3d& start, const Matrix& reference, int width,
                 long steps, Eigen::Index& next, Vector& turned, Drive& drive);
  // The heading where the lanes of a block begin.
  void begin_lanes(const Drive& drive, const Block& block, const Vector& h, kernel::CostSums& sums) const;
  kernel::StreamBlock kernel_block(const Block& block) const;
  bool turns_little(const Vector& h) const;
  // R (h - h0) + q
  Vector heading_residual(const Vector& h) const;
  double joined_cost(double positions, const Vector& heading_residual, double position, double heading) const;
  double drive_cost(const Drive& drive, const double* rows, const Vector& h) const;
  void add_drive(const Drive& drive, const double* rows, const Vector& h, const Matrix& heading_by,
                 const kernel::StreamDerivatives& by, NormalTotals& totals) const;

  kernel::Kernel kernel_;
  kernel::StepRule rule_;
  Eigen::Index streams_;
  Vector origin_;  // h0
  Matrix rows_;    // of the heading's factor while drives are added, then R, q and rest
  Eigen::Index filled_ = 0;
  Vector largest_;  // |s| of a step, per stream
  std::vector<Drive> drives_;
  std::vector<double> data_;
};

}  // namespace odobench
