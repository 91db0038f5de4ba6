#include "datasets/import/vitko2024/synchronise.hpp"

#include <numbers>

namespace odobench {

StampRepair make_increasing(std::span<std::int64_t> stamps) {
  StampRepair repair{0, stamps.size()};
  for (std::size_t k = 1; k < stamps.size(); ++k) {
    if (stamps[k] > stamps[k - 1]) continue;
    if (stamps[k - 1] - stamps[k] > kLargestBackstep_us) {
      repair.fault = k;
      return repair;
    }
    stamps[k] = stamps[k - 1] + 1;
    ++repair.moved;
  }
  return repair;
}

void unwrap(std::span<double> angles) {
  double turns = 0, previous = angles.empty() ? 0 : angles[0];
  for (double& angle : angles) {
    const double raw = angle;
    if (raw - previous > std::numbers::pi) turns -= 1;
    if (raw - previous < -std::numbers::pi) turns += 1;
    angle = raw + turns * (2 * std::numbers::pi);
    previous = raw;
  }
}

std::vector<double> interpolate(std::span<const std::int64_t> time, std::span<const double> value,
                                std::span<const std::int64_t> at) {
  std::vector<double> out;
  out.reserve(at.size());
  std::size_t k = 0;  // the segment [time[k], time[k + 1]], the outer ones continued
  for (const std::int64_t t : at) {
    while (k + 2 < time.size() && t >= time[k + 1]) ++k;
    const double part = static_cast<double>(t - time[k]) / static_cast<double>(time[k + 1] - time[k]);
    out.push_back(t == time[k + 1] ? value[k + 1] : value[k] + (value[k + 1] - value[k]) * part);
  }
  return out;
}

}  // namespace odobench
