#include "bench/catalogue/problem_factory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "base/error.hpp"
#include "base/range.hpp"
#include "base/sha256.hpp"
#include "base/text.hpp"
#include "bench/catalogue/locations.hpp"
#include "bench/catalogue/loss_choice.hpp"
#include "datasets/native/columns.hpp"
#include "datasets/native/robot_json.hpp"
#include "problems/calibration/classical/classical.hpp"

namespace odobench {

std::vector<ParameterInfo> robot_parameters(const Robot& robot) {
  return robot.parameters;
}

namespace {

// A set may hold any finite number; sums of squares may not.
void require_range(const std::string& path, const std::vector<Recording>& recordings, int schema) {
  for (const Recording& r : recordings)
    for_each_value_column(
        r, schema, [&](const std::string& name, const char*, const std::vector<double>& values) {
          for (std::size_t k = 0; k < values.size(); ++k)
            if (!in_range(values[k]))
              throw DataError(fmt::format(
                  "{}: recording '{}': {}, sample {}: found {}, expected a number of at most {:g} in size",
                  path, r.id, name, k, values[k], kLargestNumber));
        });
}

// The mean of the wheels' velocities is the twist of a robot whose wheels stand evenly round the origin. Said
// from 2 % of their mean distance: calibrated robots are never quite even.
void remark_on_mean(const Robot& robot, std::vector<std::string>& remarks) {
  constexpr double kUneven = 0.02;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  std::vector<double> distances;
  double mean = 0;
  const auto wheels = static_cast<double>(robot.table.wheels.size());
  for (std::size_t i = 0; i < robot.table.wheels.size(); ++i) {
    Eigen::Vector2d place(robot.table.wheels[i].x, robot.table.wheels[i].y);
    for (const BoundParameter& p : robot.table.parameters)
      for (const Binding& b : p.bindings) {
        if (b.wheel != i) continue;
        if (b.field == WheelField::X) place[0] += b.factor * p.parameter.nominal;
        if (b.field == WheelField::Y) place[1] += b.factor * p.parameter.nominal;
      }
    centre += place / wheels;
    distances.push_back(place.norm());
    mean += distances.back() / wheels;
  }
  double spread = 0;
  for (const double d : distances) spread = std::max(spread, std::abs(d - mean));
  if (centre.norm() <= kUneven * mean && spread <= kUneven * mean) return;
  remarks.push_back(fmt::format(
      "the wheels do not stand evenly round the robot's origin (their centre is {:.3f} m away, their "
      "distances "
      "differ by up to {:.3f} m from the mean): the published mean of their velocities is not the robot's "
      "velocity then; --twist=least_squares is",
      centre.norm(), spread));
}

// "[segments,arc]": what a problem's name has to say, so that J of different kinds never meet in a table.
std::string variant_of(const CalibrationProblem& problem, const Robot& robot,
                       const std::vector<SetAside>& without) {
  constexpr std::size_t kNamed = 3;
  std::string names, left;
  for (const SetAside& one : without) names += (names.empty() ? "" : "+") + one.recording.id;
  if (without.size() > kNamed)
    left = fmt::format("[without:{}_recordings:{}]", without.size(), sha256(names).substr(0, 8));
  else if (!without.empty())
    left = "[without:" + names + "]";
  if (problem.structured() && !problem.options().loss.robust()) return left;
  std::string text = problem.options().text();
  const TwistRule rule = problem.options().model.twist.value_or(robot.table.rule);
  if (!problem.options().model.twist && rule == TwistRule::LeastSquares && robot.kinematics == "4wis4wid")
    text += ", least_squares";
  std::erase(text, ' ');
  return "[" + text + "]" + left;
}

void remark_on_reference(ReferenceKind kind, const CalibrationChoice& asked, const CalibrationChoice& choice,
                         std::vector<std::string>& remarks) {
  if (kind == ReferenceKind::Drifting && !asked.cost)
    remarks.push_back(fmt::format("the reference drifts: --cost=segments, of {:g} m", choice.distance));
  if (kind == ReferenceKind::Headings)
    remarks.push_back(
        "the reference is a gyro: headings alone are compared, which tell ratios of lengths and no length; "
        "errors of positions are those to the wheels' own path along the gyro's headings");
}

// Of a two-wheeled robot with a reference that drifts: the closed form that needs no start of its own, and
// lands near the optimum of segments (docs/references.md). Elsewhere nothing.
void start_by_pieces(LoadedProblem& loaded) {
  const CalibrationOptions& options = loaded.calibration->options();
  if (loaded.dataset->reference != ReferenceKind::Drifting || options.cost != CostKind::Segments) return;
  const std::string name = options.mount ? "censi_mount" : "censi";
  const classical::Method& method = classical::method(name);
  classical::Options by;
  by.distance = options.distance;
  const std::vector<Recording>& recordings = loaded.calibration->recordings();
  if (!method.why_not(loaded.dataset->robot, recordings, by).empty()) return;
  Vector z = loaded.problem.start();
  try {
    const classical::Result found = method.run(loaded.dataset->robot, recordings, by);
    z.head(found.z.size()) = found.z;
    if (options.mount) z.tail<3>() = found.mount;
  } catch (const std::invalid_argument&) {
    return;
  }
  if (!z.allFinite()) return;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const ParameterInfo& p = loaded.problem.parameters()[static_cast<std::size_t>(i)];
    z[i] = std::clamp(z[i], p.lower, p.upper);
  }
  loaded.start_name = name;
  loaded.start = std::move(z);
  loaded.remarks.push_back(fmt::format("start: {}, the closed form piece by piece", name));
}

}  // namespace

CalibrationChoice choice_for(ReferenceKind kind, CalibrationChoice choice) {
  if (kind == ReferenceKind::Poses) return choice;
  if (kind == ReferenceKind::Headings) {
    const bool weighted =
        choice.estimate_weights || choice.position_weight != 1 || choice.heading_weight != 1;
    if (choice.cost == CostKind::Optiodom || weighted || choice.mount || choice.loss.robust())
      throw std::invalid_argument(
          "the reference is a gyro's headings: no --cost=optiodom, --weights, --mount, --loss, which need "
          "positions");
    choice.position_weight = 0;
  }
  if (!choice.cost) choice.cost = CostKind::Segments;
  return choice;
}

CalibrationChoice screened() {
  CalibrationChoice choice;
  choice.screen = kUsualScreen;
  return choice;
}

CalibrationOptions calibration_options(const Robot& robot, const CalibrationChoice& choice) {
  CalibrationOptions options;
  options.cost = choice.cost.value_or(CostKind::EverySample);
  options.rule = choice.rule.value_or(robot.rule);
  options.position_weight = choice.position_weight;
  options.heading_weight = choice.heading_weight;
  options.distance = choice.distance;
  options.mount = choice.mount;
  options.piece_seconds = choice.piece_seconds;
  options.piece_metres = choice.piece_metres;
  options.model = model_terms(choice.model.value_or(robot.model));
  options.mount = options.mount || options.model.mount;
  options.from_origin = robot.kinematics == "4wis4wid";
  return options;
}

std::vector<Recording> LoadedProblem::all_recordings() const {
  if (!calibration) return {};
  std::vector<Recording> all = calibration->recordings();
  for (const SetAside& one : set_aside)  // their places ascend
    all.insert(all.begin() + static_cast<std::ptrdiff_t>(one.place), one.recording);
  return all;
}

LoadedProblem load_calibration(const std::string& data, InstructionSet kernel,
                               const CalibrationChoice& asked) {
  require_consistent(asked);
  const std::filesystem::path path = data.empty() ? demo_set() : std::filesystem::path(data);
  Dataset dataset = load_dataset(path);
  require_range(path.string(), dataset.recordings, fits_schema_1(dataset.robot) ? 1 : 2);
  const CalibrationChoice choice = choice_for(dataset.reference, asked);
  if (choice.twist) dataset.robot.table.rule = *choice.twist;
  std::vector<std::string> remarks;
  remark_on_reference(dataset.reference, asked, choice, remarks);
  std::shared_ptr<const CalibrationProblem> model, aside;
  LeftOut out;
  LossStart start;
  if (choice.model) model_terms(*choice.model);  // what is wrong with the option is no fault of the set
  try {
    if (dataset.robot.table.rule == TwistRule::Mean) remark_on_mean(dataset.robot, remarks);
    CalibrationOptions options = calibration_options(dataset.robot, choice);
    out = leave_out(dataset.robot, dataset.recordings, options, choice);
    std::vector<Recording> without;
    for (const SetAside& one : out.recordings) without.push_back(one.recording);
    if (!without.empty())
      aside = std::make_shared<const CalibrationProblem>(dataset.robot, std::move(without), options, kernel);
    start = fit_loss(dataset.robot, dataset.recordings, options, choice, kernel);
    model = std::make_shared<const CalibrationProblem>(dataset.robot, std::move(dataset.recordings), options,
                                                       kernel);
    if (model->residual_count() == 0)
      throw std::invalid_argument("every recording ends before a piece of --piece does");
  } catch (const std::invalid_argument& error) {  // what is wrong with the set is no usage error
    throw DataError(fmt::format("{}: {}", path.string(), error.what()));
  }
  dataset.recordings.clear();
  const std::string variant = variant_of(*model, dataset.robot, out.recordings);
  auto apart = std::make_shared<const RecordingsApart>(dataset.robot, model);
  LoadedProblem loaded{Problem(model),       model,   std::move(dataset), path.string(),
                       sha256_of_file(path), variant, std::move(remarks)};
  loaded.apart = std::move(apart);
  loaded.set_aside = std::move(out.recordings);
  loaded.left_out = std::move(out.said);
  loaded.aside = std::move(aside);
  loaded.start_name = std::move(start.name);
  loaded.start = std::move(start.z);
  if (loaded.start_name.empty()) start_by_pieces(loaded);
  return loaded;
}

void require_4wis4wid(const LoadedProblem& loaded, const char* what) {
  if (loaded.dataset->robot.kinematics != "4wis4wid" || !loaded.calibration->structured())
    throw DataError(
        fmt::format("{}: /robot/kinematics: found \"{}\", expected \"4wis4wid\", the robot that "
                    "{} knows",
                    loaded.dataset_path, shown(loaded.dataset->robot.kinematics), what));
}

std::string box_check_sum(const std::vector<ParameterInfo>& parameters) {
  std::string text;
  for (const ParameterInfo& p : parameters)
    text += fmt::format("{} {} {:a} {:a}\n", p.name, p.unit, p.lower, p.upper);
  return sha256(text).substr(0, 16);
}

}  // namespace odobench
