// Random numbers of the generators of data: the same on every platform, for any number of threads.
#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <cstdint>

namespace odobench {

// Normal and uniform numbers with algorithms that do not depend on the standard library.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : engine_(seed) {}
  double normal(double sigma) { return sigma * normal_(engine_); }
  double uniform(double low, double high) {
    return low + (high - low) * boost::random::uniform_01<double>()(engine_);
  }
  double exponential(double mean) { return -mean * std::log1p(-uniform(0, 1)); }

 private:
  boost::random::mt19937_64 engine_;
  boost::random::normal_distribution<double> normal_;
};

// The splitmix64 finaliser: neighbouring seeds and indices get unrelated engines.
constexpr std::uint64_t mixed_seed(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t h = seed + 0x9e3779b97f4a7c15ull * (index + 1);
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
  return h ^ (h >> 31);
}

}  // namespace odobench
