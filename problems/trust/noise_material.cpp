#include "problems/trust/noise_material.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace odobench::noise {
namespace {

constexpr double kShortest = 0.25;  // m + rad
constexpr int kMostParts = 128, kLevels = 4;
constexpr std::size_t kMostSegments = 6000;  // so that hundreds of drives take a second or two

int parts_for(double progress, std::size_t drives) {
  int parts = 1;
  while (parts < kMostParts && progress / (2 * parts) >= kShortest && 4 * parts * drives <= kMostSegments)
    parts *= 2;
  return parts;
}

// Whether the drives of a kind are repetitions of one motion: parts that lie beside each other are alike.
bool alike(const Material& m, const std::vector<std::size_t>& members) {
  if (members.size() < 2) return false;
  std::map<std::pair<int, int>, std::vector<const Segment*>> places;
  for (const std::size_t n : members)
    for (const Segment& s : m.parts[n]) places[{s.level, s.index}].push_back(&s);
  std::size_t all = 0, off = 0;
  for (const auto& [place, list] : places) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Segment* s : list) mean += s->motion / static_cast<double>(list.size());
    for (const Segment* s : list) {
      ++all;
      if ((s->motion - mean).norm() > 0.35 * (s->metres + s->radians) + 0.05) ++off;
    }
  }
  return 10 * off <= all;
}

// All lengths of a drive; a length that the reference's places do not tell from the next one is left out.
// Returns how many there are.
int cut_all(const NoiseDrive& drive, const Path& path, std::size_t n, int most, std::vector<Segment>& out) {
  int levels = 0;
  std::size_t coarser = 0;
  std::vector<int> parts_of;
  for (int parts = most; parts >= 1 && parts_of.size() < kLevels; parts /= 2) parts_of.push_back(parts);
  for (std::size_t level = parts_of.size(); level-- > 0;) {
    std::vector<Segment> parts = cut(drive, path, parts_of[level]);
    if (2 * parts.size() < 3 * coarser) continue;
    coarser = parts.size();
    ++levels;
    for (Segment& s : parts) {
      s.level = static_cast<int>(level);
      s.drive = n;
      out.push_back(std::move(s));
    }
  }
  return levels;
}

double quantile_of(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Errors eight standard deviations from the median of the repetitions are no noise (a capture that lost the
// robot), and would spoil the means: they are left out, and counted. The deviation is that of the 90 %
// quantile of a length.
int drop_lost(const std::vector<std::size_t>& members, std::vector<std::vector<Segment>>& parts) {
  constexpr double kFar = 8 / 1.6448536269514722;
  if (members.size() < 3) return 0;
  std::map<std::pair<int, int>, std::vector<const Segment*>> places;
  for (const std::size_t n : members)
    for (const Segment& s : parts[n]) places[{s.level, s.index}].push_back(&s);
  std::map<std::pair<int, int>, Eigen::Vector3d> medians;
  std::map<int, std::array<std::vector<double>, 3>> deviations;
  for (const auto& [place, list] : places)
    for (int i = 0; i < 3; ++i) {
      std::vector<double> values;
      for (const Segment* s : list) values.push_back(s->error[i]);
      const double median = quantile_of(values, 0.5);
      medians[place][i] = median;
      for (const double v : values)
        deviations[place.first][static_cast<std::size_t>(i)].push_back(std::abs(v - median));
    }
  std::map<int, Eigen::Vector3d> limits;
  for (const auto& [level, lists] : deviations)
    for (int i = 0; i < 3; ++i)
      limits[level][i] = kFar * quantile_of(lists[static_cast<std::size_t>(i)], 0.9) + 1e-9;
  int lost = 0;
  for (const std::size_t n : members)
    lost += static_cast<int>(std::erase_if(parts[n], [&](const Segment& s) {
      const Eigen::Vector3d off = (s.error - medians[{s.level, s.index}]).cwiseAbs();
      return (off.array() > limits[s.level].array()).any();
    }));
  return lost;
}

std::vector<std::size_t> kept_of(const Material& m, std::size_t kind, const std::vector<bool>& keep) {
  std::vector<std::size_t> kept;
  for (const std::size_t n : m.members[kind])
    if (keep[n]) kept.push_back(n);
  return kept;
}

// Deviations from the mean over the repetitions, with the covariance of a single error.
void add_deviations(const Material& m, const std::vector<std::size_t>& kept, std::vector<Segment>& out) {
  std::map<std::pair<int, int>, std::vector<const Segment*>> places;
  for (const std::size_t n : kept)
    for (const Segment& s : m.parts[n]) places[{s.level, s.index}].push_back(&s);
  for (const auto& [place, list] : places) {
    const auto count = static_cast<double>(list.size());
    if (count < 2) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Segment* s : list) mean += s->error / count;
    for (const Segment* s : list) {
      out.push_back(*s);
      out.back().error = std::sqrt(count / (count - 1)) * (s->error - mean);
      out.back().weight = (count - 1) / count;
    }
  }
}

}  // namespace

Material prepare(const std::vector<NoiseDrive>& drives) {
  Material m;
  m.drives = &drives;
  m.parts.resize(drives.size());
  m.whole.resize(drives.size());
  std::map<std::string, std::size_t> known;
  for (std::size_t n = 0; n < drives.size(); ++n) {
    m.paths.push_back(path_of(drives[n]));
    const auto [at, fresh] = known.emplace(drives[n].trajectory, m.kinds.size());
    if (fresh) {
      m.kinds.push_back(drives[n].trajectory);
      m.members.emplace_back();
    }
    m.kind_of.push_back(at->second);
    if (m.paths[n].node.size() > 1 && m.paths[n].progress.back() > 0) m.members[at->second].push_back(n);
  }
  for (const std::vector<std::size_t>& members : m.members) {
    std::vector<double> progress;
    for (const std::size_t n : members) progress.push_back(m.paths[n].progress.back());
    std::sort(progress.begin(), progress.end());
    const int most = progress.empty() ? 1 : parts_for(progress[progress.size() / 2], drives.size());
    for (const std::size_t n : members) {
      m.levels = std::max(m.levels, cut_all(drives[n], m.paths[n], n, most, m.parts[n]));
      m.whole[n] = segment_between(drives[n], m.paths[n], 0, m.paths[n].node.size() - 1);
    }
    m.repeated.push_back(alike(m, members));
    if (m.repeated.back()) m.lost += drop_lost(members, m.parts);
  }
  return m;
}

std::vector<Segment> material_of(const Material& m, const std::vector<bool>& keep, bool separated) {
  std::vector<Segment> out;
  for (std::size_t kind = 0; kind < m.kinds.size(); ++kind) {
    const std::vector<std::size_t> kept = kept_of(m, kind, keep);
    if (!separated) {
      for (const std::size_t n : kept) out.insert(out.end(), m.parts[n].begin(), m.parts[n].end());
    } else if (m.repeated[kind]) {
      add_deviations(m, kept, out);
    }
  }
  return out;
}

}  // namespace odobench::noise
