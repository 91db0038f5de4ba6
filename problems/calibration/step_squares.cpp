#include "problems/calibration/step_squares.hpp"

namespace odobench {

using Eigen::Index;
using kernel::kHeading;

StepSquares::StepSquares() {
  wheels_.setZero();
  cross_.setZero();
  squares_.setZero();
}

void StepSquares::add(const double* cs, const double* heading) {
  if (filled_ == kRows) reduce();
  double* real = real_.data() + filled_ * kPairs;
  double* imaginary = imaginary_.data() + filled_ * kWheels * kWheels;
  double* product = products_.data() + filled_ * kProducts;
  double* f = heading_.data() + filled_ * kHeading;
  for (Index a = 0; a < kWheels; ++a)
    for (Index b = 0; b < kWheels; ++b) {
      *imaginary++ = cs[4 + a] * cs[b] - cs[a] * cs[4 + b];
      if (b <= a) *real++ = cs[a] * cs[b] + cs[4 + a] * cs[4 + b];
    }
  for (Index i = 0; i < kHeading; ++i) {
    f[i] = heading[i];
    for (Index j = 0; j <= i; ++j) *product++ = heading[i] * heading[j];
  }
  ++filled_;
}

void StepSquares::reduce() {
  const auto real = real_.topRows(filled_);
  wheels_ += real.colwise().sum().transpose();
  cross_.noalias() += imaginary_.topRows(filled_).transpose() * heading_.topRows(filled_);
  squares_.noalias() += real.transpose() * products_.topRows(filled_);
  filled_ = 0;
}

StepSquares::Squares StepSquares::at(const ConstVectorRef& s) const {
  Squares sum;
  Eigen::Matrix<double, kPairs, 1> speed;  // |u|^2 = speed . Re(w_a conj w_b)
  for (Index a = 0, pair = 0; a < kWheels; ++a)
    for (Index b = 0; b <= a; ++b, ++pair) {
      sum(a, b) = sum(b, a) = wheels_[pair];
      speed[pair] = (a == b ? 1 : 2) * s[a] * s[b];
    }
  for (Index a = 0; a < kWheels; ++a) {
    sum.block<1, kHeading>(a, kWheels) =
        s.head<kWheels>().transpose() * cross_.middleRows<kWheels>(a * kWheels);
    sum.block<kHeading, 1>(kWheels, a) = sum.block<1, kHeading>(a, kWheels).transpose();
  }
  const Eigen::Matrix<double, kProducts, 1> squares = squares_.transpose() * speed;
  for (Index i = 0, product = 0; i < kHeading; ++i)
    for (Index j = 0; j <= i; ++j, ++product)
      sum(kWheels + i, kWheels + j) = sum(kWheels + j, kWheels + i) = squares[product];
  return sum;
}

}  // namespace odobench
