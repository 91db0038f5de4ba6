#include "problems/simulation/simulated_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/parallel.hpp"
#include "base/random.hpp"

namespace odobench::simulate {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kTruthStep_s = 0.1;

// FNV-1a: a drive's numbers do not depend on its place in the scenario.
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t h = 0xcbf29ce484222325ull;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return h;
}

Json named_values(const Robot& robot, const Parameters& z) {
  Json values = Json::object();
  for (std::size_t i = 0; i < z.size(); ++i) values[robot.parameters[i].name] = z[i];
  return values;
}

std::vector<double> listed(const Parameters& z) {
  return {z.begin(), z.end()};
}

Dataset describe(const RecordingScenario& s, std::uint64_t seed) {
  Dataset d;
  d.name = s.name;
  d.description = s.description;
  d.robot = s.robot;
  for (const Drive& drive : s.drives) d.trajectories.push_back({drive.name, drive.description});
  d.known_parameters = known_parameters(s);
  d.provenance.source = "simulated by odobench";
  d.provenance.licence = "MIT";
  d.provenance.made_by = fmt::format("bench simulate --scenario={} --seed={}", s.name, seed);
  return d;
}

// Seconds on the recording's clock of a time of the logs.
double recording_time(const SimulatedDrive& d, double log_s) {
  return log_s - static_cast<double>(d.log_time_us) * 1e-6;
}

}  // namespace

std::vector<NamedParameters> known_parameters(const RecordingScenario& s) {
  return {{"truth", "the parameters that the drives were made with", listed(s.truth.parameters)},
          {"believed", "the parameters that the robot steered by", listed(s.control.believed)}};
}

SimulatedDrive simulate_drive(const RecordingScenario& s, const Drive& drive, int repetition,
                              std::uint64_t seed) {
  SimulatedDrive d;
  if (s.exact) {
    d.recording = exact_recording(s, drive);
  } else {
    d.logs = simulate_logs(
        s, drive, mixed_seed(mixed_seed(seed, hash_of(drive.name)), static_cast<std::uint64_t>(repetition)));
    d.recording = recording_of(d.logs, &d.log_time_us);
  }
  d.recording.trajectory = drive.name;
  d.recording.repetition = repetition;
  d.recording.id = fmt::format("{}_{}", drive.name, repetition);
  return d;
}

SimulatedSet simulate_set(const RecordingScenario& s, std::uint64_t seed, int threads) {
  validate(s, s.name);
  SimulatedSet set{describe(s, seed), {}};
  const auto repetitions = static_cast<std::size_t>(s.repetitions);
  set.drives.resize(s.drives.size() * repetitions);
  parallel_for(set.drives.size(), threads, [&](std::size_t i) {
    set.drives[i] = simulate_drive(s, s.drives[i / repetitions], static_cast<int>(i % repetitions) + 1, seed);
  });
  for (SimulatedDrive& d : set.drives) set.dataset.recordings.push_back(std::move(d.recording));
  return set;
}

std::string truth_json(const RecordingScenario& s, std::uint64_t seed, const SimulatedSet& set) {
  Json gains = Json::object();
  for (const auto& [name, g] : s.slip.gains) gains[name] = {{"linear", g.linear}, {"angular", g.angular}};
  Json drives = Json::array();
  for (std::size_t i = 0; i < set.drives.size(); ++i) {
    const Recording& r = set.dataset.recordings[i];
    Json entry = {{"recording", r.id}};
    if (!s.exact) {
      const SimulatedDrive& d = set.drives[i];
      const Pose& start = d.logs.true_poses.front();
      entry["begin_s"] = recording_time(d, d.logs.begin_s);
      entry["end_s"] = recording_time(d, d.logs.end_s);
      entry["start_pose"] = {start.x, start.y, start.theta};
    }
    drives.push_back(std::move(entry));
  }
  const Json root = {
      {"schema", "odobench-truth"},
      {"schema_version", 1},
      {"scenario", s.name},
      {"seed", seed},
      {"parameters", named_values(s.robot, s.truth.parameters)},
      {"believed", named_values(s.robot, s.control.believed)},
      {"kinematics", s.truth.kinematics == Kinematics::Published ? "published" : "least-squares"},
      {"contact_offset_m", s.truth.contact_offset},
      {"slip",
       {{"fixed", s.slip.fixed},
        {"random", s.slip.random},
        {"yaw_bias_rad_s", s.slip.yaw_bias},
        {"gains", std::move(gains)}}},
      {"drives", std::move(drives)}};
  return root.dump(2) + "\n";
}

std::string truth_csv(const RecordingScenario& s, const SimulatedSet& set) {
  std::string text = "recording,time_s,x,y,theta\n";
  const auto out = std::back_inserter(text);
  const double tick_s = 1 / s.odometry.rate_hz;
  const auto stride = static_cast<std::size_t>(std::max(1L, std::lround(kTruthStep_s / tick_s)));
  for (std::size_t i = 0; i < set.drives.size(); ++i) {
    const Recording& r = set.dataset.recordings[i];
    const SimulatedDrive& d = set.drives[i];
    if (s.exact) {
      for (std::size_t k = 0; k < r.size(); k += stride)
        fmt::format_to(out, "{},{},{},{},{}\n", r.id, static_cast<double>(r.time_us[k]) * 1e-6,
                       r.reference.x[k], r.reference.y[k], r.reference.theta[k]);
    }
    for (std::size_t k = 0; k < d.logs.true_poses.size(); k += stride) {
      const Pose& p = d.logs.true_poses[k];
      fmt::format_to(out, "{},{:.6f},{},{},{}\n", r.id, recording_time(d, static_cast<double>(k) * tick_s),
                     p.x, p.y, p.theta);
    }
  }
  return text;
}

}  // namespace odobench::simulate
