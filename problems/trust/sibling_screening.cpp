#include "problems/trust/sibling_screening.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angle.hpp"
#include "problems/trust/error_scales.hpp"

namespace odobench {

using Eigen::Index;

namespace {

constexpr Index kParts = 24;
constexpr std::size_t kAround = 5, kFewest = 3;
constexpr double kAlike = 2, kMetresPerRadian = 0.2, kShort_m = 1, kAligned_rad = 0.1;

// Errors of the path by nominal parameters at the entries of the reference, and where these are.
struct Drive {
  const Recording* recording = nullptr;
  PoseTrack track;
  double heading = 0;                 // of the frame that errors are seen in
  double seconds = 0, length = 0;     // length of the smoothed path with its turning, m
  Matrix error = Matrix::Zero(3, 0);  // x, y, heading at every part of the kind's time
};

std::size_t stamp_of(const Reference& reference, std::size_t entry) {
  return reference.sample.empty() ? entry : reference.sample[entry];
}

// Medians over the entries around the first one at or after `time`: error in x, y, heading, and x, y, heading
// of the reference.
Eigen::Matrix<double, 6, 1> around(const Drive& drive, std::int64_t time) {
  const Recording& recording = *drive.recording;
  const Reference& reference = recording.reference;
  const std::size_t count = reference.x.size();
  std::size_t low = 0, high = count - 1;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (recording.time_us[stamp_of(reference, middle)] < time)
      low = middle + 1;
    else
      high = middle;
  }
  const double c = std::cos(drive.heading), s = std::sin(drive.heading);
  std::array<std::vector<double>, 6> values;
  const std::size_t last = std::min(count - 1, low + kAround);
  for (std::size_t i = low < kAround ? 0 : low - kAround; i <= last; ++i) {
    const std::size_t k = stamp_of(reference, i);
    const double dx = drive.track.x[k] - reference.x[i], dy = drive.track.y[k] - reference.y[i],
                 turned = drive.track.theta[k] - reference.theta[i];
    const double own[] = {
        c * dx + s * dy, c * dy - s * dx, reference.sample.empty() ? turned : wrapped_angle(turned),
        reference.x[i],  reference.y[i],  reference.theta[i]};
    for (std::size_t v = 0; v < values.size(); ++v) values[v].push_back(own[v]);
  }
  Eigen::Matrix<double, 6, 1> medians;
  for (std::size_t v = 0; v < values.size(); ++v)
    medians[static_cast<Index>(v)] = middle_of(std::move(values[v]));
  return medians;
}

std::int64_t part_of(double seconds, Index part) {
  return static_cast<std::int64_t>(1e6 * seconds * static_cast<double>(part) / static_cast<double>(kParts));
}

Drive drive_of(const Recording& recording, PoseTrack track) {
  Drive drive{&recording, std::move(track)};
  drive.seconds = static_cast<double>(recording.time_us.back()) * 1e-6;
  drive.heading = around(drive, 0)[5];
  Eigen::Matrix<double, 6, 1> before = around(drive, 0);
  for (Index part = 1; part <= kParts; ++part) {
    const Eigen::Matrix<double, 6, 1> now = around(drive, part_of(drive.seconds, part));
    drive.length +=
        (now - before).segment<2>(3).norm() + kMetresPerRadian * std::abs(wrapped_angle(now[5] - before[5]));
    before = now;
  }
  return drive;
}

// Recordings of one trajectory that are alike.
std::vector<std::size_t> repetitions(std::vector<std::size_t> members, const std::vector<Drive>& drives) {
  std::vector<double> seconds, lengths;
  for (const std::size_t n : members) {
    seconds.push_back(drives[n].seconds);
    lengths.push_back(drives[n].length);
  }
  const double usual_s = middle_of(seconds), usual_m = middle_of(lengths);
  std::erase_if(members, [&](std::size_t n) {
    const auto unlike = [](double value, double usual, double slack) {
      return value > kAlike * usual + slack || kAlike * (value + slack) < usual;
    };
    return unlike(drives[n].seconds, usual_s, 0) || unlike(drives[n].length, usual_m, kShort_m);
  });
  return members;
}

// (D_xy, D_th) of every member from the median curve of all.
std::vector<std::array<double, 2>> deviations(const std::vector<std::size_t>& members,
                                              const std::vector<Drive>& drives) {
  Matrix usual(3, kParts);
  for (Index i = 0; i < usual.size(); ++i) {
    std::vector<double> values;
    for (const std::size_t n : members) values.push_back(drives[n].error.data()[i]);
    usual.data()[i] = middle_of(std::move(values));
  }
  std::vector<std::array<double, 2>> list;
  for (const std::size_t n : members) {
    const Matrix off = drives[n].error - usual;
    list.push_back(
        {std::sqrt(off.topRows(2).squaredNorm() / kParts), std::sqrt(off.row(2).squaredNorm() / kParts)});
  }
  return list;
}

struct Kind {
  std::string trajectory;
  std::vector<std::size_t> members;
  std::vector<std::array<double, 2>> deviations;
};

std::vector<Kind> kinds_by_trajectory(std::span<const Recording> recordings, std::vector<Drive>& drives) {
  std::vector<Kind> kinds;
  for (std::size_t n = 0; n < recordings.size(); ++n) {
    const auto same = [&](const Kind& kind) { return kind.trajectory == recordings[n].trajectory; };
    auto at = std::find_if(kinds.begin(), kinds.end(), same);
    if (at == kinds.end()) at = kinds.insert(kinds.end(), {recordings[n].trajectory, {}, {}});
    at->members.push_back(n);
  }
  for (Kind& kind : kinds) kind.members = repetitions(std::move(kind.members), drives);
  std::erase_if(kinds, [](const Kind& kind) { return kind.members.size() < kFewest; });
  for (Kind& kind : kinds) {
    double shortest = drives[kind.members.front()].seconds;
    bool aligned = true;  // they begin in one direction, and are seen in the frame of the reference
    for (const std::size_t n : kind.members) {
      shortest = std::min(shortest, drives[n].seconds);
      const double turned = drives[n].heading - drives[kind.members.front()].heading;
      aligned = aligned && std::abs(wrapped_angle(turned)) <= kAligned_rad;
    }
    for (const std::size_t n : kind.members)
      if (aligned) drives[n].heading = 0;
    for (const std::size_t n : kind.members) {
      drives[n].error.resize(3, kParts);
      for (Index part = 1; part <= kParts; ++part)
        drives[n].error.col(part - 1) = around(drives[n], part_of(shortest, part)).head<3>();
    }
    kind.deviations = deviations(kind.members, drives);
  }
  return kinds;
}

double median_of(const std::vector<const Kind*>& kinds, std::size_t which) {
  std::vector<double> values;
  for (const Kind* kind : kinds)
    for (const auto& d : kind->deviations) values.push_back(d[which]);
  return middle_of(std::move(values));
}

}  // namespace

bool Screening::any_compared() const {
  return std::any_of(scores.begin(), scores.end(), [](const SiblingScore& s) { return s.compared; });
}

std::vector<std::size_t> Screening::set_aside() const {
  std::vector<std::size_t> list;
  for (std::size_t n = 0; n < scores.size(); ++n)
    if (scores[n].set_aside) list.push_back(n);
  return list;
}

Screening screen_siblings(const Robot& robot, std::span<const Recording> recordings,
                          const CalibrationOptions& options, double limit) {
  Screening screening;
  screening.limit = limit;
  screening.scores.resize(recordings.size());
  CalibrationOptions plain = options;
  plain.cost = CostKind::EverySample;
  plain.loss = {};
  std::vector<Drive> drives;
  for (const Recording& recording : recordings) {
    const CalibrationProblem one(robot, {recording}, plain);
    Vector z(static_cast<Index>(one.parameters().size()));
    for (Index i = 0; i < z.size(); ++i) z[i] = one.parameters()[static_cast<std::size_t>(i)].nominal;
    drives.push_back(drive_of(recording, one.integrate(0, z)));
  }
  const std::vector<Kind> kinds = kinds_by_trajectory(recordings, drives);
  std::vector<const Kind*> all;
  for (const Kind& kind : kinds) all.push_back(&kind);
  for (const Kind& kind : kinds) {
    std::size_t above = 0;
    for (std::size_t i = 0; i < kind.members.size(); ++i) {
      SiblingScore& score = screening.scores[kind.members[i]];
      score.compared = true;
      for (const std::size_t which : {0U, 1U}) {
        const double usual = std::max(median_of({&kind}, which), median_of(all, which));
        if (usual > 0) score.z = std::max(score.z, kind.deviations[i][which] / usual);
      }
      if (score.z > limit) ++above;
    }
    if (2 * above >= kind.members.size()) {
      screening.undecided.push_back(kind.trajectory);
      continue;
    }
    for (const std::size_t n : kind.members) screening.scores[n].set_aside = screening.scores[n].z > limit;
  }
  return screening;
}

}  // namespace odobench
