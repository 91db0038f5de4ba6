#include "bench/studies/calibration/classical_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.hpp"
#include "base/names.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/records.hpp"
#include "problems/calibration/classical/classical.hpp"
#include "problems/calibration/drive_errors.hpp"

namespace odobench {
namespace {

std::vector<std::string> known_methods() {
  std::vector<std::string> names;
  for (const classical::Method& m : classical::methods()) names.push_back(m.name);
  return names;
}

classical::Options classical_options(const LoadedProblem& loaded, const ClassicalChoice& choice) {
  classical::Options options;
  options.side = choice.side;
  options.distance = loaded.calibration->options().distance;
  return options;
}

// What a method finds on the problem's recordings, or why there is nothing.
struct Finding {
  classical::Result result;
  std::string reason;
};

Finding calibrated_by(const classical::Method& method, const LoadedProblem& loaded,
                      const ClassicalChoice& choice) {
  const Robot& robot = loaded.dataset->robot;
  const std::vector<Recording>& recordings = loaded.calibration->recordings();
  const classical::Options options = classical_options(loaded, choice);
  Finding found;
  found.reason = loaded.dataset->reference == ReferenceKind::Headings
                     ? "the reference has headings and no positions"
                     : method.why_not(robot, recordings, options);
  if (!found.reason.empty()) return found;
  try {
    found.result = method.run(robot, recordings, options);
    if (!found.result.z.allFinite())
      found.reason = "its equations have no finite solution on these recordings";
    for (Eigen::Index i = 0; i < found.result.z.size(); ++i)
      if (const RobotParameter& p = robot.parameters[static_cast<std::size_t>(i)];
          p.lower == p.upper && found.result.z[i] != p.nominal)
        found.reason = fmt::format("it finds {}, which the robot holds fixed", p.name);
  } catch (const std::invalid_argument& error) {
    found.reason = error.what();
    if (const std::string prefix = method.name + ": "; found.reason.rfind(prefix, 0) == 0)
      found.reason.erase(0, prefix.size());
  }
  return found;
}

// The problem's parameters: the robot's, then the mount where it is free.
Vector problem_parameters(const LoadedProblem& loaded, const classical::Result& result) {
  Vector z = loaded.problem.start();
  z.head(result.z.size()) = result.z;
  if (z.size() == result.z.size() + 3 && result.mount.size() == 3 &&
      loaded.problem.parameters().back().name == "mount_yaw")
    z.tail(3) = result.mount;
  return z;
}

// Lower is better of what is left after the calibration; the others are intermediate values.
void add_classical_measures(const classical::Result& result, RunRecord& record) {
  for (const classical::Figure& f : result.figures) {
    const bool after = f.name.size() > 6 && f.name.compare(f.name.size() - 6, 6, "_after") == 0;
    record.measures.put({f.name, f.value, f.unit == "1" ? "" : f.unit, after ? Better::Lower : Better::None});
  }
  const char* const axes[] = {"x", "y", "yaw"};
  for (Eigen::Index i = 0; i < result.mount.size(); ++i)
    record.measures.put({fmt::format("mount_{}", axes[i]), result.mount[i], i < 2 ? "m" : "rad"});
  const char* const twists[] = {"dx", "dy", "dyaw"};
  for (Eigen::Index row = 0; row < result.matrix.rows(); ++row)
    for (Eigen::Index wheel = 0; wheel < result.matrix.cols(); ++wheel)
      record.measures.put({fmt::format("matrix.{}.{}", twists[row], wheel + 1), result.matrix(row, wheel),
                           row < 2 ? "" : "rad/m"});
}

RunRecord matrix_record(const LoadedProblem& loaded, const std::string& label, const Matrix& matrix,
                        const RunContext& context) {
  const CalibrationProblem& problem = *loaded.calibration;
  std::vector<PoseTrack> tracks;
  for (const Matrix& poses : classical::tracks_by_matrix(matrix, loaded.dataset->robot, problem.recordings(),
                                                         problem.options().rule)) {
    const auto row = [&](Eigen::Index i) {
      const Vector values = poses.row(i).transpose();
      return std::vector<double>(values.begin(), values.end());
    };
    tracks.push_back({row(0), row(1), row(2)});
  }
  return tracks_record(loaded, label, tracks, context);
}

std::string message_of(const classical::Method& method, const LoadedProblem& loaded,
                       const classical::Result& result) {
  std::string text = method.description;
  if (result.matrix.size() > 0) text += "; J and errors are those of its poses";
  if (result.mount.size() > 0 && !loaded.calibration->options().mount)
    text += "; J without the sensor's pose, which only --mount takes";
  return text;
}

}  // namespace

std::vector<std::string> classical_methods(const ClassicalChoice& choice, const std::string& kinematics) {
  std::vector<std::string> names;
  const auto take = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  const std::vector<std::string> asked = comma_items(choice.names);
  if (asked.empty())
    for (const classical::Method& m : classical::methods())
      if (std::find(m.classes.begin(), m.classes.end(), kinematics) != m.classes.end()) take(m.name);
  for (const std::string& name : asked) {
    if (name == "all") {
      for (const std::string& one : known_methods()) take(one);
      continue;
    }
    try {
      take(classical::method(name).name);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("--classical={}: {}", name, error.what()));
    }
  }
  return names;
}

std::vector<RunRecord> classical_records(const LoadedProblem& loaded, const ClassicalChoice& choice,
                                         const RunContext& context, std::vector<ParameterSet>* sets,
                                         Watcher& watcher) {
  std::vector<RunRecord> records;
  if (!choice.wanted) return records;
  const std::string& kinematics = loaded.dataset->robot.kinematics;
  for (const std::string& name : classical_methods(choice, kinematics)) {
    const classical::Method& method = classical::method(name);
    const std::string label = "classical:" + name;
    const Finding found = calibrated_by(method, loaded, choice);
    if (!found.reason.empty()) {
      records.push_back(skipped_record(loaded, label, found.reason, context));
      continue;
    }
    if (found.result.z.size() > 0) {
      const Vector z = problem_parameters(loaded, found.result);
      records.push_back(evaluation_record(loaded, label, z, context));
      if (sets != nullptr) sets->push_back({label, z});
    } else {
      records.push_back(matrix_record(loaded, label, found.result.matrix, context));
    }
    records.back().message = message_of(method, loaded, found.result);
    add_classical_measures(found.result, records.back());
  }
  if (records.empty())
    watcher.note(fmt::format("--classical: no classical method is made for robots of class {}", kinematics));
  return records;
}

Vector classical_start(const LoadedProblem& loaded, const std::string& name, const ClassicalChoice& choice,
                       std::vector<std::string>& notes) {
  if (!loaded.calibration)
    throw std::invalid_argument(fmt::format(
        "--start={}: the problem '{}' is no calibration, expected nominal or random", name, loaded.name()));
  const Finding found = calibrated_by(classical::method(name), loaded, choice);
  std::string reason = found.reason;
  if (reason.empty() && found.result.z.size() == 0) reason = "it finds a matrix, no parameters to start from";
  if (!reason.empty()) throw DataError(fmt::format("{}: --start={}: {}", loaded.dataset_path, name, reason));
  Vector z = problem_parameters(loaded, found.result);
  std::string moved;
  for (std::size_t i = 0; i < loaded.problem.parameters().size(); ++i) {
    const ParameterInfo& p = loaded.problem.parameters()[i];
    double& value = z[static_cast<Eigen::Index>(i)];
    const double inside = std::clamp(value, p.lower, p.upper);
    if (inside == value) continue;
    moved += fmt::format("{}{} from {:.6g} to {:.6g}", moved.empty() ? "" : ", ", p.name, value, inside);
    value = inside;
  }
  if (!moved.empty()) notes.push_back(fmt::format("--start={}: moved into the box: {}", name, moved));
  return z;
}

void require_start(const std::string& name) {
  std::vector<std::string> known = known_methods();
  known.insert(known.begin(), {"nominal", "random"});
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw std::invalid_argument(
        fmt::format("--start={}: expected nominal or random, or a classical method{}; known: {}", name,
                    did_you_mean(name, known), fmt::join(known, ", ")));
}

}  // namespace odobench
