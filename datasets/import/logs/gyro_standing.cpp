#include "datasets/import/logs/gyro_standing.hpp"

#include <algorithm>
#include <cmath>

namespace odobench::log_import {
namespace {

constexpr double kStillWindow = 0.25;  // s, to either side of a stamp
constexpr double kStillTurn = 0.01;    // rad that a wheel turns in it at most
constexpr double kLeast = 0.5;         // s of standing that tell a bias

}  // namespace

std::optional<Standing> gyro_standing(const LogMap& map, const std::vector<Curve>& signals, const Curve& gyro,
                                      const std::map<std::string, double>& offsets) {
  const auto shift = [&](const Curve& curve) {
    const auto found = offsets.find(curve.source);
    return found == offsets.end() ? 0.0 : found->second;
  };
  std::vector<std::size_t> hints(2 * signals.size());
  const auto turned = [&](std::size_t i, double t) {
    const double at = t + shift(signals[i]);
    return std::abs(signals[i].at(at + kStillWindow, hints[2 * i]) -
                    signals[i].at(at - kStillWindow, hints[2 * i + 1]));
  };
  double sum = 0, squares = 0, seconds = 0, count = 0;
  for (std::size_t k = 1; k < gyro.time.size(); ++k) {
    const double t = gyro.time[k] - shift(gyro);
    bool stands = true;
    for (std::size_t i = 0; stands && i < signals.size(); ++i) {
      if (map.signals[i].format.signal_kind() == SignalKind::Angle) continue;
      const Curve& wheel = signals[i];
      stands = t - kStillWindow >= wheel.time.front() - shift(wheel) &&
               t + kStillWindow <= wheel.time.back() - shift(wheel) && turned(i, t) <= kStillTurn;
    }
    if (!stands) continue;
    sum += gyro.value[k];
    squares += gyro.value[k] * gyro.value[k];
    seconds += std::min(kStillWindow, gyro.time[k] - gyro.time[k - 1]);
    ++count;
  }
  if (seconds < kLeast || count < 3) return std::nullopt;
  const double mean = sum / count;
  return Standing{mean, std::sqrt(std::max(0.0, squares / count - mean * mean)), seconds};
}

}  // namespace odobench::log_import
