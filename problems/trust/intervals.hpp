// 95 % intervals of numbers that a calibration determines, from the moves when recordings are left out.
//
// On the free parameters F (no bound active), in q = z / scale, with scores g_n and informations H_n of G
// recordings, H = sum H_n, Hx the exact Hessian of J/2 on F where it is positive definite, else H:
//     d_n = (Hx - H_n - (Hx - H)/G)^-1 g_n                     the move when recording n is left out
//     v = (G-1)/G sum (c'd_n - mean)^2,  K = c'Hx^-1,  w_n = K H_n K'
//     nu = max(2, (sum w_n)^2 / sum w_n^2),  c'q +- t_.975(nu) sqrt(v)            "new kinds of drive"
//     v_s = sum over kinds of f_k sum (c'd_n - mean of the kind)^2,  t_.975((G - K)/G nu) "the same drives"
// f_k = max(1, 4/5 k/(k-1)) of a kind with k repetitions: 1 from five on; what the mean of fewer takes
// from their spread is given back.
//
// They hold what differs between recordings. An error common to all of them (frame, clock, slip) is not
// in them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "problems/trust/covariances.hpp"
#include "problems/trust/recording_scores.hpp"

namespace odobench {

// Why there is no interval.
enum class NoInterval {
  None,                    // there is one
  OneRecording,            // G = 1
  TooFewRecordings,        // G < 5
  NoNoise,                 // J at its rounding floor
  Undetermined,            // any value fits
  OneRecordingTells,       // leverage above 0.999
  TooFewDegreesOfFreedom,  // below 1
  BoundActive,             // single parameters, while any lies on a bound
  WiderThanBox,            // single parameters: the box decides
  NotRepeated              // "the same drives": a kind was driven once
};
// Short and stable, for machines: "bound_active".
std::string_view name_of(NoInterval reason);

inline constexpr std::size_t kLeastRecordings = 5;
inline constexpr double kLargestLeverage = 0.999;

struct Interval {
  // Of drives of new kinds: standard deviation, degrees of freedom, half width. NaN where refused.
  double deviation, df, half_width;
  // Of the same drives again; NaN where a kind was driven once.
  double same_deviation, same_df, same_half_width;
  NoInterval refused = NoInterval::None;
  std::string reason;  // a sentence; "" where there is an interval

  Interval();
};

// Reasons that hold for every number of these recordings; None and "" where there is none.
Interval general_refusal(const RecordingScores& scores);

// The exact Hessian of J/2 in q on scores.parameters by central differences of the exact gradient.
// half_gradient: z -> J'r (all parameters, their units). Evaluates 2 n gradients.
Matrix exact_half_hessian(const std::function<Vector(const Vector& z)>& half_gradient,
                          const RecordingScores& scores, const ConstVectorRef& z, double step = 1e-5);

class LeaveOneOut {
 public:
  // `scores` of the free parameters. `exact`: as above, or empty for J'J.
  LeaveOneOut(const RecordingScores& scores, const Matrix& exact);

  // c: by q of the free parameters.
  Interval interval(const Vector& c) const;
  // The same with a scatter of single drives added to the variance: of an error on a new drive.
  Interval interval(const Vector& c, double scatter) const;

  bool uses_exact() const { return exact_; }
  // Eigenvalues of the exact Hessian in q, ascending; empty without one.
  const Vector& eigenvalues() const { return eigenvalues_; }
  const Vector& leverages() const { return leverages_; }

 private:
  bool factorise(const Matrix& curvature);  // false where a curvature left is not positive definite

  RecordingScores scores_;
  KindsOfDrives kinds_;
  Interval general_;
  RecordingCovariances covariances_;
  Matrix basis_;  // whitened coordinates that no single recording decides
  std::vector<Vector> g_;
  std::vector<Matrix> h_;
  Matrix inverse_, moves_;  // Hx^-1 and d_n (columns), whitened
  Vector eigenvalues_, leverages_;
  bool exact_ = false;
};

// CR3 with Satterthwaite's degrees of freedom for c'q over all of scores.parameters (bounds ignored).
Interval jackknife_interval(const RecordingScores& scores, const RecordingCovariances& covariances,
                            const Vector& c);

}  // namespace odobench
