#include "base/random.hpp"

namespace odobench {

std::uint64_t derive_seed(std::uint64_t base, std::initializer_list<std::string_view> parts) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  const auto mix = [&hash](unsigned char byte) {
    hash ^= byte;
    hash *= 0x100000001b3ull;
  };
  for (int shift = 0; shift < 64; shift += 8) mix(static_cast<unsigned char>(base >> shift));
  for (std::string_view part : parts) {
    for (char c : part) mix(static_cast<unsigned char>(c));
    mix(0xff);  // no text contains it: {"ab","c"} and {"a","bc"} differ
  }
  return mixed_seed(hash, 0);
}

}  // namespace odobench
