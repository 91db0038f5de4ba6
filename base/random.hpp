// Random numbers that are the same on every platform and thread count: engines are passed in, seeds are
// derived by hash, distributions are Boost's (whose algorithms, unlike those of <random>, do not depend on
// the standard library).
#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace odobench {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  // Uniform in [0, 1).
  double uniform() { return boost::random::uniform_01<double>()(engine_); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  // Standard normal.
  double normal() { return normal_(engine_); }
  double normal(double sigma) { return sigma * normal_(engine_); }
  double exponential(double mean) { return -mean * std::log1p(-uniform()); }
  // Uniform in {low, ..., high}, both ends included.
  std::int64_t integer(std::int64_t low, std::int64_t high) {
    return boost::random::uniform_int_distribution<std::int64_t>(low, high)(engine_);
  }
  boost::random::mt19937_64& engine() { return engine_; }

 private:
  boost::random::mt19937_64 engine_;
  boost::random::normal_distribution<double> normal_;
};

// Hash (FNV-1a over the parts with separators, then the splitmix64 finaliser) of a base seed and the names of
// a table cell, so that any cell can be rerun alone: derive_seed(base, {problem, dataset, solver, "3"}).
std::uint64_t derive_seed(std::uint64_t base, std::initializer_list<std::string_view> parts);

// The splitmix64 finaliser: neighbouring seeds and indices get unrelated engines.
constexpr std::uint64_t mixed_seed(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t h = seed + 0x9e3779b97f4a7c15ull * (index + 1);
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
  return h ^ (h >> 31);
}

}  // namespace odobench
