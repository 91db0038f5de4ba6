// Seeded normal numbers for tests, the same on every platform.
#pragma once

#include <Eigen/Core>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cstdint>

namespace odobench::testing {

class Normal {
 public:
  explicit Normal(std::uint64_t seed) : engine_(seed) {}
  double operator()(double sigma) { return sigma * normal_(engine_); }
  Eigen::Vector3d three(const Eigen::Vector3d& sigma) {
    return {(*this)(sigma[0]), (*this)(sigma[1]), (*this)(sigma[2])};
  }

 private:
  boost::random::mt19937_64 engine_;
  boost::random::normal_distribution<double> normal_;
};

}  // namespace odobench::testing
