// The innermost loops of the structured form, in several vector widths chosen at run time.
//
// A block holds `width` segments of one recording, each `steps` increments long, one segment per vector lane:
//     data[(step * kStreams + stream) * width + lane]
// with the streams C_1..C_4, S_1..S_4 (C_i = dt w_i cos(d_i) / 4, S_i = dt w_i sin(d_i) / 4, in rad) and the
// reference position after the step relative to the segment's start, x and y [m].
// Linear parameters s = (r_1..r_4, P_1..P_4, Q_1..Q_4), P_i = r_i b_i/(a_i^2+b_i^2), Q_i = r_i
// a_i/(a_i^2+b_i^2):
//     u = sum r_i (C_i, S_i),   dtheta = sum -P_i C_i + Q_i S_i,   (dx, dy) = R(theta) u.
// Inside a segment the heading is advanced by rotating (cos, sin) by dtheta; segments begin from exact prefix
// sums. Everything is relative to the segment's start, so segments are independent of each other.
#pragma once

namespace odobench {
enum class InstructionSet;  // problems/instruction_set.hpp, which files of wide instructions must not include
}

namespace odobench::kernel {

inline constexpr int kStreams = 10;
inline constexpr int kLinear = 12;
inline constexpr int kHeading = 8;  // P_1..P_4, Q_1..Q_4
inline constexpr int kMaxWidth = 8;
// Largest |dtheta| of a step for which the rotation polynomial is exact to 1e-15; beyond it the `exact` form
// is used.
inline constexpr double kMaxAngle = 0.3;

struct Block {
  const double* data;
  long steps;
};

// Arrays indexed [lane] (or [entry][lane]); lanes >= width are not touched.
struct CostSums {
  double cos0[kMaxWidth], sin0[kMaxWidth];  // in: heading at the segment's start
  double x[kMaxWidth], y[kMaxWidth];        // displacement over the segment
  double ex[kMaxWidth], ey[kMaxWidth];      // sums of the errors e = position - reference
  double squares[kMaxWidth];                // sum of ex^2 + ey^2
};

// Of any robot whose motions are M s, with S streams s a step (problems/calibration/linear_streams.hpp):
//     data[(step * (streams + 2) + stream) * width + lane], the last two the reference position as above.
// m: M (3 x S), row by row. The motion (ux, uy, d) of a step is turned by the heading at its start, after
//     Euler's rule    nothing
//     midpoint        a turn by d / 2
//     arc             (ux a - uy b, ux b + uy a), a = sin(d) / d, b = (1 - cos(d)) / d.
enum class StepRule { Euler, Midpoint, Arc };
struct StreamBlock {
  const double* data;
  long steps;
  int streams;
  StepRule rule;
};
inline constexpr int kMostStreams = 16;

// Derivatives by at most kMostColumns numbers. Lower triangles are stored row by row: (i, j) is entry
// i (i + 1) / 2 + j. The twelve of s, in their order, or the parameters of a robot.
inline constexpr int kMostColumns = 24;
inline constexpr int triangle(int columns) {
  return columns * (columns + 1) / 2;
}

// e = position - reference, g = its derivative, all relative to the segment's start.
struct NormalSums {
  CostSums cost;
  double heading0[kMostColumns][kMaxWidth];  // in: derivative of the heading at the segment's start; 0 for r
  double gx[kMostColumns][kMaxWidth], gy[kMostColumns][kMaxWidth];          // over the segment
  double sum_gx[kMostColumns][kMaxWidth], sum_gy[kMostColumns][kMaxWidth];  // sums over the samples
  double jtr[kMostColumns][kMaxWidth];                                      // sum of gx ex + gy ey
  // Sum of gx gx' + gy gy'. Of `normal` without half the sum of d d' over every second step, the last of the
  // segment among them, where d is the change of g in that step: see StepSquares.
  double jtj[triangle(kMostColumns)][kMaxWidth];
};

// dM/dz_p, 3 x S row by row, one after the other: by[(p * 3 + row) * streams + stream].
struct StreamDerivatives {
  const double* by;
  int columns;
};

struct Kernel {
  int width;  // lanes of a block
  void (*cost)(const Block&, const double* s, bool exact, CostSums&);
  void (*normal)(const Block&, const double* s, bool exact, NormalSums&);
  // The same for blocks of width 1 (the last few steps of a recording).
  void (*cost_tail)(const Block&, const double* s, bool exact, CostSums&);
  void (*normal_tail)(const Block&, const double* s, bool exact, NormalSums&);
  // Steps must turn by less than kMaxAngle.
  void (*streams)(const StreamBlock&, const double* m, CostSums&);
  void (*streams_tail)(const StreamBlock&, const double* m, CostSums&);
  void (*streams_normal)(const StreamBlock&, const double* m, const StreamDerivatives&, NormalSums&);
  void (*streams_normal_tail)(const StreamBlock&, const double* m, const StreamDerivatives&, NormalSums&);
};

// Throws std::invalid_argument when the processor does not have it.
Kernel select(InstructionSet set);

}  // namespace odobench::kernel
