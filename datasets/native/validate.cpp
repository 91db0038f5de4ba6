#include "datasets/native/validate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "base/sha256.hpp"
#include "base/text.hpp"
#include "datasets/robot_4wis4wid.hpp"

namespace odobench {
namespace {

void require(bool holds, const std::string& file, const std::string& path, const std::string& message) {
  if (!holds) throw DataError(fmt::format("{}: {}: {}", file, path, message));
}

class Validator {
 public:
  Validator(const Dataset& dataset, const std::string& file) : d_(dataset), file_(file) {}

  void run() const {
    require(!d_.name.empty(), "/name", "found an empty text, expected a name");
    validate_robot(d_.robot, file_);
    check_trajectories();
    check_recordings();
    check_known_parameters();
    for (std::size_t i = 0; i < d_.provenance.files.size(); ++i)
      require(is_sha256(d_.provenance.files[i].sha256), fmt::format("/provenance/files/{}/sha256", i),
              fmt::format("found \"{}\", expected 64 lower-case hexadecimal digits",
                          shown(d_.provenance.files[i].sha256)));
  }

 private:
  void require(bool holds, const std::string& path, const std::string& message) const {
    odobench::require(holds, file_, path, message);
  }
  void require_new(std::set<std::string>& seen, const std::string& name, const std::string& path) const {
    require(!name.empty(), path, "found an empty text, expected a name");
    require(seen.insert(name).second, path,
            fmt::format("found \"{}\" a second time, expected every name once", shown(name)));
  }

  void check_trajectories() const {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < d_.trajectories.size(); ++i)
      require_new(seen, d_.trajectories[i].name, fmt::format("/trajectories/{}/name", i));
  }

  void check_recordings() const {
    require(!d_.recordings.empty(), "/recordings", "found none, expected at least one");
    std::set<std::string> ids;
    std::set<std::string_view> trajectories;
    for (const Trajectory& t : d_.trajectories) trajectories.insert(t.name);
    std::set<std::pair<std::string, int>> repetitions;
    for (std::size_t i = 0; i < d_.recordings.size(); ++i) {
      const Recording& r = d_.recordings[i];
      const std::string path = fmt::format("/recordings/{}", i);
      require_new(ids, r.id, path + "/id");
      const auto plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-' || c == '.';
      };
      require(std::all_of(r.id.begin(), r.id.end(), plain) && r.id[0] != '.', path + "/id",
              fmt::format("found \"{}\", expected letters, digits, '_', '-' and '.', not beginning with '.'",
                          shown(r.id)));
      require(trajectories.count(r.trajectory) != 0, path + "/trajectory",
              fmt::format("found \"{}\", expected the name of one of the {} trajectories",
                          shown(r.trajectory), d_.trajectories.size()));
      require(r.repetition >= 1, path + "/repetition",
              fmt::format("found {}, expected 1 or more", r.repetition));
      require(repetitions.insert({r.trajectory, r.repetition}).second, path + "/repetition",
              fmt::format("found repetition {} of \"{}\" a second time, expected every one once",
                          r.repetition, shown(r.trajectory)));
    }
  }

  void check_known_parameters() const {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < d_.known_parameters.size(); ++i) {
      const NamedParameters& known = d_.known_parameters[i];
      const std::string path = fmt::format("/known_parameters/{}", i);
      require_new(seen, known.name, path + "/name");
      require(known.values.size() == d_.robot.parameters.size(), path + "/values",
              fmt::format("found {} values, expected {}", known.values.size(), d_.robot.parameters.size()));
      for (std::size_t k = 0; k < known.values.size(); ++k)
        require(std::isfinite(known.values[k]), path + "/values/" + d_.robot.parameters[k].name,
                fmt::format("found {}, expected a finite number", known.values[k]));
    }
  }

  const Dataset& d_;
  const std::string& file_;
};

}  // namespace

namespace {

// Names and units of the thesis' robot, which schema 1 states in full.
void require_4wis4wid(const Robot& robot, const std::string& file) {
  const Robot known = robot_4wis4wid();
  require(robot.parameters.size() == known.parameters.size(), file, "/robot/parameters",
          fmt::format("found {} parameters, expected {}", robot.parameters.size(), known.parameters.size()));
  for (std::size_t i = 0; i < robot.parameters.size(); ++i) {
    const RobotParameter &p = robot.parameters[i], &expected = known.parameters[i];
    const std::string path = fmt::format("/robot/parameters/{}", i);
    require(p.name == expected.name, file, path + "/name",
            fmt::format("found \"{}\", expected \"{}\"", shown(p.name), expected.name));
    require(p.unit == expected.unit, file, path + "/unit",
            fmt::format("found \"{}\", expected \"{}\"", shown(p.unit), expected.unit));
  }
}

}  // namespace

void validate_robot(const Robot& robot, const std::string& file) {
  const auto require = [&](bool holds, const std::string& path, const std::string& message) {
    odobench::require(holds, file, path, message);
  };
  require(!robot.name.empty(), "/robot/name", "found an empty text, expected a name");
  // Without a table the robot is of schema 1.
  if (robot.table.wheels.empty())
    require(robot.kinematics == "4wis4wid", "/robot/kinematics",
            fmt::format("found \"{}\", expected \"4wis4wid\"", shown(robot.kinematics)));
  if (robot.kinematics == "4wis4wid" && robot.ties.empty()) require_4wis4wid(robot, file);
  for (std::size_t i = 0; i < robot.parameters.size(); ++i) {
    const RobotParameter& p = robot.parameters[i];
    const std::string path = fmt::format("/robot/parameters/{}", i);
    require(std::isfinite(p.nominal) && std::isfinite(p.lower) && std::isfinite(p.upper), path,
            fmt::format("found lower {}, nominal {}, upper {} of {}, expected finite numbers", p.lower,
                        p.nominal, p.upper, p.name));
    require(
        p.lower <= p.upper, path,
        fmt::format("found lower {} > upper {} of {}, expected lower <= upper", p.lower, p.upper, p.name));
    require(p.lower <= p.nominal && p.nominal <= p.upper, path,
            fmt::format("found nominal {} of {} outside [{}, {}], expected it inside", p.nominal, p.name,
                        p.lower, p.upper));
  }
}

void validate_dataset(const Dataset& dataset, const std::string& file) {
  Validator(dataset, file).run();
}

}  // namespace odobench
