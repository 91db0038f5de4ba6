#include "bench/studies/entropy/unit_watch.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>

#include "base/angle.hpp"

namespace odobench {
namespace {

constexpr double kFastest = 15;                         // m/s
constexpr double kLongPeriod = 5, kShortPeriod = 1e-4;  // s
constexpr double kSure = 0.7;                           // correlation
constexpr double kNear = 1.3;
constexpr double kLeastTurn = 2;  // deg, root mean square since the start

bool near(double value, double factor) {
  return value > factor / kNear && value < factor * kNear;
}

}  // namespace

UnitWatch::UnitWatch(const EntropyConstants& constants)
    : constants_(constants), unit_(Predictor(constants).predict(0, 0, 1)) {
  find_weights();
}

void UnitWatch::find_weights() {
  Eigen::Matrix<double, 4, 3> a;
  for (Eigen::Index w = 0; w < 4; ++w) {
    const auto i = static_cast<std::size_t>(w);
    const double c = std::cos(steering_[i] + alpha(constants_)),
                 s = std::sin(steering_[i] + alpha(constants_));
    a.row(w) << c, s, c * unit_.x[i] + s * unit_.y[i];
  }
  const Eigen::Matrix<double, 3, 4> inverse = a.completeOrthogonalDecomposition().pseudoInverse();
  for (Eigen::Index w = 0; w < 4; ++w) weights_[static_cast<std::size_t>(w)] = inverse(2, w) * unit_.rotation;
}

void UnitWatch::add(const ConvertedRow& row) {
  if (row.sample.steering != steering_) {
    steering_ = row.sample.steering;
    find_weights();
  }
  double size = 0;
  for (std::size_t w = 0; w < 4; ++w) {
    turned_ += weights_[w] * row.sample.wheel[w];
    size += std::abs(row.sample.wheel[w]) / 4;
  }
  said_ += row.sample.rotation;
  by_wheels_ += turned_ * turned_;
  both_ += turned_ * said_;
  given_ += said_ * said_;
  path_ += size;
  if (rows_ == 0) first_ = size;
  if (size > last_) growing_ += 1;
  last_ = size;
  rows_ += 1;
}

std::vector<std::string> UnitWatch::remarks() const {
  std::vector<std::string> all;
  if (rows_ < 2) return all;
  const double step = path_ / rows_, dt = constants_.dt, speed = step / dt;
  const bool long_period = dt > kLongPeriod;
  if (long_period || dt < kShortPeriod)
    all.push_back(fmt::format("time_s: a sampling period of {:g} s: {}?", dt,
                              long_period ? "are these milliseconds" : "what unit is this"));
  if (growing_ > 0.95 * (rows_ - 1) && last_ > 5 * first_ + 1e-9)
    all.push_back(
        fmt::format("enc1_m to enc4_m: they only grow, from {:.3g} to {:.3g} m: distances since the start, "
                    "where those of "
                    "each step are expected?",
                    first_, last_));
  else if (speed > kFastest)
    all.push_back(fmt::format(
        "enc1_m to enc4_m: {:.3g} m a step of {:g} s, {:.3g} m/s: are these millimetres?", step, dt, speed));
  const double correlation = both_ / std::sqrt(by_wheels_ * given_);
  if (!(by_wheels_ > kLeastTurn * kLeastTurn * rows_) || !(std::abs(correlation) > kSure)) return all;
  const double factor = both_ / by_wheels_;
  const char* what = near(std::abs(factor), 1 / kDegree) ? ": are these degrees where the name says radians?"
                     : near(std::abs(factor), kDegree)   ? ": are these radians where the name says degrees?"
                     : factor < -0.3 ? ": its sign, or the order of the wheels (--wheel-order)?"
                     : near(factor, 1 / dt) && dt < 1 / kNear ? ": is this a rate where a step is expected?"
                     : near(factor, dt) && dt < 1 / kNear     ? ": is this a step where a rate is expected?"
                                                              : "";
  if (*what != '\0')
    all.push_back(fmt::format("rotation: {:.3g} times what the wheels say (correlation {:.2f}){}", factor,
                              correlation, what));
  return all;
}

}  // namespace odobench
