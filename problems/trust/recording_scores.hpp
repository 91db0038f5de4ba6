// Score and information of every recording of a calibration, in relative parameters q = z / scale (scale:
// |nominal|, or half the box where nominal is 0): what intervals, tests and held-out predictions are made of.
#pragma once

#include <string>
#include <vector>

#include "problems/calibration/recording_costs.hpp"

namespace odobench {

struct RecordingScores {
  std::vector<std::string> recordings, kinds;  // ids and trajectories, G of each
  std::vector<Eigen::Index> parameters;        // places in the problem's list of the n that stand here
  Vector scale;                                // of these (n)
  std::vector<Vector> g;                       // scores J_n'r_n in q (n)
  std::vector<Matrix> h;                       // informations J_n'J_n in q (n x n)
  Vector costs;                                // J_n
  Eigen::Index residuals = 0;
  double rounding_floor = 0;  // of sum J_n (problems/problem.hpp)

  std::size_t size() const { return g.size(); }
  double cost() const { return costs.sum(); }
  Matrix information() const;  // sum of h
};

// At z, of the parameters whose bounds differ.
RecordingScores recording_scores(const RecordingCosts& costs, const ConstVectorRef& z);

// The same of fewer parameters: `places` among scores.parameters.
RecordingScores restricted(const RecordingScores& scores, const std::vector<Eigen::Index>& places);

// Kinds of drives as the units of information: g_n, h_n and J_n of a kind summed, its name as that of the
// recording.
RecordingScores merged_by_kind(const RecordingScores& scores);

// Whether a parameter lies within 1e-6 of the width of its box of an end of it; never where the bounds are
// alike.
bool on_bound(const ParameterInfo& parameter, double value);

// Half the gradient of J = sum J_n by all parameters, in their units.
Vector half_gradient(const RecordingCosts& costs, const Vector& z);

// Different kinds in order of first appearance, and the kind of each recording as its place among them.
struct KindsOfDrives {
  std::vector<std::string> names;
  std::vector<std::size_t> of;      // G
  std::vector<std::size_t> counts;  // recordings of each kind
};
KindsOfDrives kinds_of(const std::vector<std::string>& kinds);

}  // namespace odobench
