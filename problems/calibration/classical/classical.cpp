#include "problems/calibration/classical/classical.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "base/names.hpp"
#include "problems/calibration/classical/methods.hpp"

namespace odobench::classical {
namespace {

using Reason = std::string (*)(const Drives&);
using Calculation = Result (*)(const Drives&);

struct Needs {
  std::vector<std::string> classes;
  std::vector<std::string> parameters;
};

// What all methods ask for; "" and the drives where it is there.
std::string reason_of(const Needs& needs, Reason reason, const Robot& robot,
                      const std::vector<Recording>& recordings, const Options& options) {
  if (std::find(needs.classes.begin(), needs.classes.end(), robot.kinematics) == needs.classes.end())
    return fmt::format("the robot is of class {}, expected {}", robot.kinematics,
                       fmt::join(needs.classes, " or "));
  for (const std::string& name : needs.parameters)
    if (std::none_of(robot.parameters.begin(), robot.parameters.end(),
                     [&](const RobotParameter& p) { return p.name == name; }))
      return fmt::format("the robot has no parameter '{}' of its own: it is tied to another", name);
  if (recordings.empty()) return "there are no recordings";
  for (const Recording& recording : recordings)
    if (recording.size() < 2)
      return fmt::format("recording {} has {} samples, expected at least 2", recording.id, recording.size());
  try {
    return reason(Drives(robot, recordings, options));
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

Method make_method(const std::string& name, const Needs& needs, const std::string& description, Reason reason,
                   Calculation calculation) {
  const auto why_not = [needs, reason](const Robot& robot, const std::vector<Recording>& recordings,
                                       const Options& options) {
    return reason_of(needs, reason, robot, recordings, options);
  };
  const auto run = [name, why_not, calculation](const Robot& robot, const std::vector<Recording>& recordings,
                                                const Options& options) {
    const std::string problem = why_not(robot, recordings, options);
    if (!problem.empty()) throw std::invalid_argument(fmt::format("{}: {}", name, problem));
    try {
      return calculation(Drives(robot, recordings, options));
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(fmt::format("{}: {}", name, e.what()));
    }
  };
  return {name, needs.classes, description, why_not, run};
}

}  // namespace

double Result::figure(std::string_view name) const {
  for (const Figure& f : figures)
    if (f.name == name) return f.value;
  throw std::out_of_range(fmt::format("no figure '{}'", name));
}

const std::vector<Method>& methods() {
  static const Needs kDifferential = {{"differential"}, {"b", "r_right", "r_left"}};
  static const Needs kTricycle = {{"tricycle"}, {"wheelbase", "r", "steering_zero"}};
  static const Needs kOmni = {{"omni3", "mecanum"}, {"r1", "r2", "r3"}};
  static const std::vector<Method> list = {
      make_method("umbmark", kDifferential,
                  "squares in both senses: track and ratio of radii from the ends' x", why_no_squares,
                  umbmark_x),
      make_method("umbmark_y", kDifferential,
                  "squares in both senses: track and ratio of radii from the ends' y", why_no_squares,
                  umbmark_y),
      make_method("jung_chung", kDifferential,
                  "squares in both senses: track and ratio of radii from the ends' headings", why_no_squares,
                  jung_chung),
      make_method("jung_chung_optiodom", kDifferential,
                  "the same as OptiOdom's programs compute it: mean headings divided by the runs once more",
                  why_no_squares, jung_chung_of_optiodom),
      make_method("circles", kDifferential,
                  "circles in both senses: track and radii from turns and end positions", why_no_circles,
                  circles),
      make_method(
          "ivanjko", kDifferential,
          "straight lines, then turns on the spot in both senses: radii from the lines, track from the turns",
          why_no_lines_and_turns, ivanjko),
      make_method(
          "kallasi", kTricycle,
          "any drive that turns: radius (by the nominal wheelbase) and zero of the steering from headings",
          why_no_turning, kallasi),
      make_method("lin", kOmni, "any drive that turns: a matrix of twists by wheel paths, not a geometry",
                  why_no_turning, lin),
      make_method("antonelli", kDifferential,
                  "any drive that turns: headings, then positions, both linear in the wheels", why_no_turning,
                  antonelli),
      make_method("censi", kDifferential, "any drive that turns, in pieces: track and radii", why_no_turning,
                  censi),
      make_method(
          "censi_mount", kDifferential,
          "any drive that turns, in pieces of different curvature: track, radii and the sensor's pose",
          why_no_turning, censi_with_mount)};
  return list;
}

const Method& method(std::string_view name) {
  std::vector<std::string> known;
  for (const Method& m : methods()) {
    if (m.name == name) return m;
    known.push_back(m.name);
  }
  throw std::invalid_argument(fmt::format("unknown classical method '{}'{}; known: {}", name,
                                          did_you_mean(name, known), fmt::join(known, ", ")));
}

}  // namespace odobench::classical
