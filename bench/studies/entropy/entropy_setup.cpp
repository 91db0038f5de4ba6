#include "bench/studies/entropy/entropy_setup.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"
#include "base/names.hpp"
#include "bench/catalogue/option_values.hpp"
#include "problems/entropy/entropy_model.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace {

// 0.0085554224 = 0.4 * 0.021388556 rad/s^2, the largest angular acceleration of the thesis' robot: its
// program uses the number for deg/s^2.
constexpr double kThesisStepRotation = 0.0085554224;
// The window loop of the thesis' program ends two windows before the data do.
constexpr std::int64_t kThesisRowsUnused = 2;

// The rotation column that a value of --theta stands for.
const std::map<std::string, std::string>& theta_meanings() {
  static const std::map<std::string, std::string> meanings = {
      {"step-deg", "yaw_step_deg"},   {"step-rad", "yaw_step_rad"}, {"rate-deg", "yaw_rate_deg_s"},
      {"rate-rad", "yaw_rate_rad_s"}, {"absolute-deg", "yaw_deg"},  {"absolute-rad", "yaw_rad"},
      {"raw", "yaw_step_deg"}};
  return meanings;
}

// Of "enc1=enc1_n" the left side in full: enc1_m.
std::string canonical(const char* option, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return name;
  std::vector<std::string> longer;
  for (const std::string& candidate : known)
    if (candidate.size() > name.size() && candidate.rfind(name + "_", 0) == 0) longer.push_back(candidate);
  if (longer.size() == 1) return longer.front();
  if (!longer.empty())
    throw std::invalid_argument(fmt::format("{}: '{}' needs its unit: {} ...", option, name, longer.front()));
  throw std::invalid_argument(
      fmt::format("{}: unknown name '{}'{}", option, name, did_you_mean(name, known)));
}

ColumnMapping parse_columns(const char* option, const std::vector<std::string>& lists,
                            const std::vector<std::string>& known) {
  ColumnMapping mapping;
  for (const std::string& list : lists)
    for (const std::string& item : comma_items(list)) {
      const auto equals = item.find('=');
      if (equals == std::string::npos || equals == 0 || equals + 1 == item.size())
        throw std::invalid_argument(
            fmt::format("{}={}: expected name=column, found '{}'", option, list, item));
      const std::string name = canonical(option, item.substr(0, equals), known);
      if (!mapping.emplace(name, item.substr(equals + 1)).second)
        throw std::invalid_argument(fmt::format("{}: '{}' is given twice", option, name));
    }
  return mapping;
}

// One of two words as true for the first.
bool first_of(const char* option, const std::string& word, const char* first, const char* second) {
  if (word == first) return true;
  if (word == second) return false;
  throw std::invalid_argument(fmt::format("{}={}: expected {} or {}", option, word, first, second));
}

}  // namespace

FilterSetup make_filter_setup(const EntropyOptions& options) {
  FilterSetup setup;
  const bool published = options.as_published;
  setup.constants = options.constants;
  setup.constants.step_rotation =
      options.step_rotation.value_or(published ? kThesisStepRotation : kThesisStepRotation / kDegree);
  if (options.dt) setup.constants.dt = *options.dt;
  validate(setup.constants);

  setup.turn_accelerations =
      first_of("--accelerometer-frame", options.accelerometer_frame.value_or(published ? "filter" : "robot"),
               "robot", "filter");
  setup.omega_cross_v = options.omega_cross_v.value_or(!published);
  const bool right_first =
      first_of("--wheel-order", options.wheel_order.value_or("right-first"), "right-first", "left-first");
  setup.rotation_sign = right_first ? 1 : -1;
  setup.rows_unused = published ? kThesisRowsUnused : 0;

  FilterRunOptions& reader = setup.reader;
  reader.columns = parse_columns("--columns", options.columns, filter_run_columns());
  const std::string theta = options.theta.value_or(published ? "raw" : "step-deg");
  const auto meaning = theta_meanings().find(theta);
  if (meaning == theta_meanings().end()) {
    std::vector<std::string> known;
    for (const auto& [name, column] : theta_meanings()) known.push_back(name);
    throw std::invalid_argument(
        fmt::format("--theta={}: expected {}{}", theta, fmt::join(known, ", "), did_you_mean(theta, known)));
  }
  reader.theta = meaning->second;
  reader.rotation_as_it_stands = theta == "raw";
  reader.use_laikas = !published;
  reader.dt = options.dt;
  if (published && !reader.dt) reader.dt = setup.constants.dt;
  reader.time_tolerance = options.time_tolerance;
  reader.resample = options.resample;
  if (options.resample && !options.truth.empty())
    throw std::invalid_argument("--resample and --truth: rows that are filled in have no truth");
  if (options.compare_kalman && options.truth.empty())
    throw std::invalid_argument("--compare=kalman: errors are those against a truth; give --truth, too");
  reader.least_rows = setup.constants.samples + setup.rows_unused;
  setup.truth_columns = parse_columns("--truth-columns", options.truth_columns, FilterTruthReader::columns());
  return setup;
}

SampleConverter::SampleConverter(const FilterSetup& setup)
    : setup_(setup),
      predictor_(setup.constants),
      alpha_(alpha(setup.constants)),
      cos_alpha_(std::cos(alpha_)),
      sin_alpha_(std::sin(alpha_)) {
  cos_.fill(cos_alpha_);
  sin_.fill(sin_alpha_);
}

const ConvertedRow& SampleConverter::convert(const FilterRow& row) {
  EntropySample& sample = row_.sample;
  sample.wheel = row.wheel;
  sample.steering = row.steering;
  sample.rotation = setup_.rotation_sign * row.rotation_deg;
  sample.ax = setup_.turn_accelerations ? row.ax * cos_alpha_ - row.ay * sin_alpha_ : row.ax;
  sample.ay = setup_.turn_accelerations ? row.ay * cos_alpha_ + row.ax * sin_alpha_ : row.ay;
  double sum_x = 0, sum_y = 0;
  for (std::size_t w = 0; w < 4; ++w) {
    if (row.steering[w] != steering_[w]) {
      steering_[w] = row.steering[w];
      cos_[w] = std::cos(steering_[w] + alpha_);
      sin_[w] = std::sin(steering_[w] + alpha_);
    }
    sum_x += row_.x[w] = row.wheel[w] * cos_[w];
    sum_y += row_.y[w] = row.wheel[w] * sin_[w];
  }
  if (setup_.omega_cross_v) {
    const double dt = setup_.constants.dt, omega = row.rotation_deg * kDegree / dt;
    sample.ax += omega * sum_y / (4 * dt);
    sample.ay -= omega * sum_x / (4 * dt);
  }
  return row_;
}

TrueSample SampleConverter::convert(const FilterTruth& truth) const {
  TrueSample sample{truth.sx, truth.sy, truth.ax, truth.ay, setup_.rotation_sign * truth.rotation_deg,
                    {},       {}};
  if (truth.wheel) {
    for (std::size_t w = 0; w < 4; ++w) {
      sample.x[w] = (*truth.wheel)[w][0];
      sample.y[w] = (*truth.wheel)[w][1];
    }
  } else {
    const double r = sample.rotation / degrees_per_metre(setup_.constants);
    const EntropyPrediction p = predictor_.predict(truth.sx, truth.sy, r);
    sample.x = p.x;
    sample.y = p.y;
  }
  return sample;
}

}  // namespace odobench
