#include "datasets/import/logs/drive_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/range.hpp"

namespace odobench::log_import {
namespace {

constexpr double kWindow = 0.25;      // s
constexpr double kStanding = 0.01;    // rad in a window
constexpr double kLeft = 0.5;         // s of standing at the ends of a drive
constexpr double kLongestPart = 2e6;  // s, 23 days
constexpr double kUsualSteps = 3;     // a gap is longer, where a source is slow

// A gap of this curve is a longer step.
double longest_step(const Curve& curve, double limit) {
  return std::max(limit, kUsualSteps * curve.median_step());
}

}  // namespace

PartFinder::PartFinder(const LogMap& map, const LogCurves& curves, double reference_shift,
                       const std::vector<double>& shifts)
    : map_(map), curves_(curves), reference_shift_(reference_shift), shifts_(shifts) {}

Part PartFinder::common_time() const {
  Part wheels{-kInfinity, kInfinity, ""};
  for (std::size_t i = 0; i < curves_.signals.size(); ++i) {
    wheels.from = std::max(wheels.from, curves_.signals[i].time.front() - shifts_[i]);
    wheels.to = std::min(wheels.to, curves_.signals[i].time.back() - shifts_[i]);
  }
  if (curves_.x.time.empty()) {
    if (wheels.from < wheels.to) return wheels;
    throw DataError(fmt::format("{}: the wheels' signals share no time", curves_.id));
  }
  const double first = curves_.x.time.front() - reference_shift_,
               last = curves_.x.time.back() - reference_shift_;
  const Part whole{std::max(wheels.from, first), std::min(wheels.to, last), ""};
  if (whole.from < whole.to) return whole;
  const double begin = static_cast<double>(curves_.begin_ns) * 1e-9;
  throw DataError(fmt::format(
      "{}: reference and wheels overlap by 0.0 s: reference {:.0f}..{:.0f}, wheels {:.0f}..{:.0f}: different "
      "clocks? give offset_s",
      curves_.id, begin + first, begin + last, begin + wheels.from, begin + wheels.to));
}

std::vector<Part> PartFinder::without_gaps(const Part& whole, std::vector<std::string>& notes) const {
  std::vector<Part> gaps;
  const auto add = [&](const Curve& curve, double shift, double limit) {
    const double most = longest_step(curve, limit);
    for (std::size_t k = 1; k < curve.time.size(); ++k) {
      const double from = curve.time[k - 1] - shift, to = curve.time[k] - shift;
      if (to - from <= most || to <= whole.from || from >= whole.to) continue;
      gaps.push_back({from, to, ""});
      notes.push_back(fmt::format("{}: {} has a gap of {:.2f} s at {:.2f} s: the drive is split there",
                                  curves_.id, curve.name, to - from, from - whole.from));
    }
  };
  add(curves_.x, reference_shift_, map_.reference_gap_s);
  for (std::size_t i = 0; i < curves_.signals.size(); ++i)
    add(curves_.signals[i], shifts_[i], map_.wheel_gap_s);
  std::sort(gaps.begin(), gaps.end(), [](const Part& a, const Part& b) { return a.from < b.from; });
  std::vector<Part> parts;
  double from = whole.from;
  for (const Part& gap : gaps) {
    if (gap.from > from) parts.push_back({from, gap.from, ""});
    from = std::max(from, gap.to);
  }
  if (from < whole.to) parts.push_back({from, whole.to, ""});
  return parts;
}

std::vector<Part> PartFinder::moving(const Part& part, double longest) const {
  std::vector<Part> all;
  std::vector<std::size_t> hints(curves_.signals.size(), 0);
  std::vector<double> before(curves_.signals.size());
  if (!(part.to - part.from < kLongestPart))
    throw DataError(fmt::format("{}: a drive of {:.3g} s, expected at most {:.0g}", curves_.id,
                                part.to - part.from, kLongestPart));
  const auto steps = static_cast<long>(std::ceil((part.to - part.from) / kWindow));
  for (long k = 0; k <= steps; ++k) {
    const double t = std::min(part.to, part.from + static_cast<double>(k) * kWindow);
    bool moves = false;
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (map_.signals[i].format.signal_kind() == SignalKind::Angle) continue;
      const double angle = curves_.signals[i].at(t + shifts_[i], hints[i]);
      moves = moves || (k > 0 && std::abs(angle - before[i]) > kStanding);
      before[i] = angle;
    }
    if (!moves) continue;
    if (all.empty() || t - kWindow - all.back().to >= longest) all.push_back({t - kWindow, t, ""});
    all.back().to = t;
  }
  for (Part& one : all)
    one = {std::max(part.from, one.from - kLeft), std::min(part.to, one.to + kLeft), part.name};
  return all;
}

std::vector<Part> PartFinder::find(std::vector<std::string>& notes) const {
  const Part whole = common_time();
  std::vector<Part> wanted;
  if (map_.split == Split::Marks)
    for (const Mark& mark : map_.marks)
      wanted.push_back({std::max(whole.from, mark.from_s), std::min(whole.to, mark.to_s), mark.name});
  else
    wanted.push_back(whole);
  std::vector<Part> parts;
  std::size_t too_short = 0;
  double stood = 0;
  for (const Part& one : wanted) {
    if (!(one.from < one.to)) continue;
    for (Part& part : without_gaps(one, notes)) {
      part.name = one.name;
      const double longest = map_.split == Split::Standstill ? map_.standstill_s : kInfinity;
      std::vector<Part> drives = moving(part, longest);
      if (drives.empty()) drives.push_back(part);  // it never moves, which others will say
      double kept = 0;
      for (const Part& drive : drives) {
        kept += drive.to - drive.from;
        if (drive.to - drive.from < map_.shortest_drive_s)
          ++too_short;
        else
          parts.push_back(drive);
      }
      stood += part.to - part.from - kept;
    }
  }
  if (stood > kLeft)
    notes.push_back(
        fmt::format("{}: {:.1f} s of standing left out, {} s kept at each end", curves_.id, stood, kLeft));
  if (too_short > 0)
    notes.push_back(
        fmt::format("{}: {} parts shorter than {} s left out", curves_.id, too_short, map_.shortest_drive_s));
  return parts;
}

}  // namespace odobench::log_import
