// Fewer samples of curves without moving them by more than a stated amount.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace odobench {

// A curve over common abscissae, and how far a straight line between kept samples may be from it.
struct DecimatedChannel {
  std::span<const double> values;
  double tolerance = 0;  // >= 0, unit of the values
};

// Indices to keep, ascending, of samples over `abscissa` (strictly increasing): the first, the last, the
// largest and the smallest of every channel, and as many more as the linear interpolation between kept
// samples needs to stay within the tolerance of every channel at every sample. One pass: from a kept sample
// the slopes that meet all samples since form a cone; when a sample leaves it, the one before is kept (J.
// Sklansky and V. Gonzalez, Fast polygonal approximation of digitized curves, Pattern Recognition 12, 1980).
// Values that are not finite are always kept. Throws std::invalid_argument when lengths differ.
std::vector<std::size_t> decimate(std::span<const double> abscissa,
                                  const std::vector<DecimatedChannel>& channels);

// Indices to keep, ascending: the first, the last, and the smallest and the largest of each of `stretches`
// parts of equal length. For curves whose noise exceeds any tolerance that would save much. Values that are
// not finite are passed over. Throws std::invalid_argument for no stretches.
std::vector<std::size_t> extremes(std::span<const double> values, std::size_t stretches);

}  // namespace odobench
