// Drives cut into parts, kind by kind: a private header of noise_fit.cpp.
#pragma once

#include <string>
#include <vector>

#include "problems/trust/noise_segments.hpp"

namespace odobench::noise {

// The drives that can be used, cut; what belongs together.
struct Material {
  const std::vector<NoiseDrive>* drives = nullptr;
  std::vector<Path> paths;
  std::vector<std::vector<Segment>> parts;  // of each drive, all levels
  std::vector<Segment> whole;               // of each drive
  std::vector<std::string> kinds;
  std::vector<std::size_t> kind_of;  // of each drive
  std::vector<std::vector<std::size_t>> members;
  std::vector<bool> repeated;  // of each kind
  int levels = 0, lost = 0;
};

// Cuts all drives, finds out which kinds are repeated, leaves out parts that lie eight standard deviations
// from the median of their repetitions.
Material prepare(const std::vector<NoiseDrive>& drives);

// What the model is fitted to: of repeated kinds where `separated`, else all errors as they are.
std::vector<Segment> material_of(const Material& m, const std::vector<bool>& keep, bool separated);

}  // namespace odobench::noise
