#include "tests/support/data/corrupted_drives.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "datasets/robot_4wis4wid.hpp"

namespace odobench::testing {
namespace {

constexpr std::size_t kWheels = 4;
constexpr const char *kSwapped = "circle_ccw_3", *kSlipping = "line_x_2", *kOutliers = "line_y_3",
                     *kFrozen = "circle_cw_2";

Recording& recording_called(std::vector<Recording>& recordings, const std::string& id) {
  for (Recording& r : recordings)
    if (r.id == id) return r;
  throw std::invalid_argument("no recording " + id);
}

std::vector<double>& signal(Recording& r, const std::string& name) {
  for (Signal& s : r.signals)
    if (s.name == name) return s.values;
  throw std::invalid_argument("no signal " + name);
}

std::vector<double>& speed(Recording& r, std::size_t wheel) {
  const std::vector<double>* values = &wheel_speed_of(r, wheel);
  for (Signal& s : r.signals)
    if (&s.values == values) return s.values;
  throw std::invalid_argument("no wheel speed");
}

void exchange(Recording& r, std::size_t a, std::size_t b) {
  std::swap(speed(r, a), speed(r, b));
  std::string names[2];
  for (const Signal& s : r.signals) {
    if (&s.values == &steering_of(r, a)) names[0] = s.name;
    if (&s.values == &steering_of(r, b)) names[1] = s.name;
  }
  std::swap(signal(r, names[0]), signal(r, names[1]));
}

void slip(Recording& r, std::size_t wheel, std::int64_t from_us, std::int64_t to_us) {
  std::vector<double>& values = speed(r, wheel);
  for (std::size_t k = 0; k < r.size(); ++k)
    if (r.time_us[k] >= from_us && r.time_us[k] < to_us) values[k] *= 2.5;
}

void displace(Recording& r, std::size_t k, double x, double y, double theta = 0) {
  r.reference.x[k] += x;
  r.reference.y[k] += y;
  r.reference.theta[k] += theta;
}

void freeze(Recording& r, std::int64_t from_us, std::int64_t to_us) {
  std::size_t last = 0;
  for (std::size_t k = 0; k < r.size(); ++k) {
    if (r.time_us[k] < from_us) last = k;
    if (r.time_us[k] < from_us || r.time_us[k] >= to_us) continue;
    r.reference.x[k] = r.reference.x[last];
    r.reference.y[k] = r.reference.y[last];
    r.reference.theta[k] = r.reference.theta[last];
  }
}

// Uniform in [0, 1) by the bits of the generator: the same with every standard library.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(unit() * static_cast<double>(count));
  }
  double normal() { return std::sqrt(-2 * std::log(1 - unit())) * std::cos(2 * std::numbers::pi * unit()); }
  std::int64_t moment(const Recording& r, double length_s) {
    const double all = static_cast<double>(r.time_us.back());
    return static_cast<std::int64_t>((0.25 + 0.5 * unit()) * (all - length_s * 1e6));
  }

 private:
  std::mt19937_64 random_;
};

std::string damage(Recording& r, const std::string& kind, Draw& draw) {
  if (kind == "slip") {
    const std::size_t wheel = draw.below(kWheels);
    const std::int64_t from = draw.moment(r, 2);
    slip(r, wheel, from, from + 2'000'000);
    return fmt::format("wheel {} times 2.5 from {:.3f} s for 2 s", wheel + 1,
                       static_cast<double>(from) * 1e-6);
  }
  if (kind == "swap") {
    const std::size_t a = draw.below(kWheels), b = (a + 1 + draw.below(kWheels - 1)) % kWheels;
    exchange(r, a, b);
    return fmt::format("modules {} and {} exchanged", std::min(a, b) + 1, std::max(a, b) + 1);
  }
  if (kind == "outlier") {
    for (std::size_t k = 1; k < r.size(); ++k) {
      if (draw.unit() >= 0.01) continue;
      const double far = 0.2 + 0.8 * draw.unit(), towards = 2 * std::numbers::pi * draw.unit();
      displace(r, k, far * std::cos(towards), far * std::sin(towards), 0.5 * draw.normal());
    }
    return "1 % of the samples displaced by 0.2 to 1 m";
  }
  if (kind != "pose") throw std::invalid_argument("no damage " + kind);
  const std::int64_t from = draw.moment(r, 3);
  const double towards = 2 * std::numbers::pi * draw.unit();
  for (std::size_t k = 0; k < r.size(); ++k)
    if (r.time_us[k] >= from && r.time_us[k] < from + 3'000'000)
      displace(r, k, 0.3 * std::cos(towards), 0.3 * std::sin(towards), 0.3);
  return fmt::format("pose displaced by 0.3 m and 0.3 rad from {:.3f} s for 3 s",
                     static_cast<double>(from) * 1e-6);
}

}  // namespace

void corrupt(std::vector<Recording>& recordings, const std::string& corruption) {
  const bool all = corruption == "all", both = corruption == "swap+slip";
  bool known = corruption == "clean" || all;
  if (all || both || corruption == "swap") {
    exchange(recording_called(recordings, kSwapped), 0, 3);
    known = true;
  }
  if (all || both || corruption == "slip") {
    slip(recording_called(recordings, kSlipping), 0, 40'000'000, 41'000'000);
    known = true;
  }
  if (all || corruption == "outliers") {
    Recording& r = recording_called(recordings, kOutliers);
    for (std::size_t j = 0; j < 20; ++j)
      displace(r, 200 + 230 * j, std::cos(2.4 * static_cast<double>(j)),
               std::sin(2.4 * static_cast<double>(j)));
    known = true;
  }
  if (all || corruption == "frozen") {
    freeze(recording_called(recordings, kFrozen), 30'000'000, 32'000'000);
    known = true;
  }
  if (!known) throw std::invalid_argument("no corruption " + corruption);
}

bool touched_by_corruptions(const std::string& recording) {
  return recording == kSwapped || recording == kSlipping || recording == kOutliers || recording == kFrozen;
}

std::vector<Damage> damage_two(std::vector<Recording>& recordings, const std::string& kind,
                               std::uint64_t seed) {
  static const char* const kKinds[] = {"slip", "swap", "outlier", "pose"};
  Draw draw(seed);
  const std::size_t first = draw.below(recordings.size());
  const std::size_t second = (first + 1 + draw.below(recordings.size() - 1)) % recordings.size();
  std::vector<Damage> done;
  for (const std::size_t n : {first, second}) {
    const std::string own = kind == "mix" ? kKinds[draw.below(4)] : kind;
    done.push_back({n, own, damage(recordings[n], own, draw)});
  }
  return done;
}

}  // namespace odobench::testing
