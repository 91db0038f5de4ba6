#include "datasets/import/optiodom/optiodom_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/angle.hpp"
#include "base/names.hpp"
#include "base/text.hpp"
#include "datasets/csv/csv_table.hpp"

namespace odobench::optiodom {
namespace {

constexpr char kSeparator = ',';
constexpr double kMostRuns = 1000;
constexpr double kMostMotion = 1e12;  // counts, turns or rad between two rows
// Of a turn of the wheel: 1 where a column holds turns.
constexpr double kLeastCounts = 1e-3, kMostCounts = 1e12;

// "name", "value 1", "value 2", ...: as many as the first line has.
std::vector<std::string> metadata_columns(std::string_view text) {
  const std::string_view first = text.substr(0, text.find('\n'));
  std::vector<std::string> names = {"name"};
  const auto values = std::count(first.begin(), first.end(), kSeparator);
  for (std::ptrdiff_t i = 1; i <= values; ++i) names.push_back(fmt::format("value {}", i));
  return names;
}

// The rows that matter, taken one by one while the table stands at them.
class MetadataRows {
 public:
  MetadataRows(std::string_view text, const std::string& file)
      : table_(text, file, kSeparator, metadata_columns(text)) {}

  Metadata read() {
    Metadata m;
    std::vector<std::string> seen;
    double gear = 0, encoder = 0;
    while (table_.next()) {
      const std::string name(table_.field(0));
      if (std::find(kNeeded.begin(), kNeeded.end(), name) != kNeeded.end() || name == "Thi" || name == "L") {
        if (std::find(seen.begin(), seen.end(), name) != seen.end())
          table_.fail(fmt::format("found a second row \"{}\", expected one", name));
        seen.push_back(name);
      }
      if (name == "type") m.type = &type();
      if (name == "ngear") gear = positive(1)[0];
      if (name == "encRes") encoder = positive(1)[0];
      if (name == "Li") m.distances = positive(known_type(m).distances);
      if (name == "Di") m.diameters = positive(known_type(m).diameters);
      if (name == "N") m.runs = count();
      if (name == "Thi" && !table_.field(first()).empty()) m.steering_zero = numbers(1)[0];
      if (name == "L" && !table_.field(first()).empty()) m.side = positive(1)[0];
    }
    for (const std::string& name : kNeeded)
      if (std::find(seen.begin(), seen.end(), name) == seen.end())
        throw DataError(fmt::format("{}:{}: found no row \"{}\" up to the end, expected one", table_.file(),
                                    table_.line() + 1, name));
    m.counts_per_turn = gear * encoder;
    if (m.counts_per_turn < kLeastCounts || m.counts_per_turn > kMostCounts)
      throw DataError(
          fmt::format("{}:{}: found {:g} counts of the encoder (ngear times encRes) in a turn of the wheel, "
                      "expected from {:g} to {:g}",
                      table_.file(), table_.line() + 1, m.counts_per_turn, kLeastCounts, kMostCounts));
    return m;
  }

 private:
  inline static const std::vector<std::string> kNeeded = {"type", "ngear", "encRes", "Li", "Di", "N"};

  // The first value's column.
  std::size_t first() const {
    if (table_.names().size() < 2) table_.fail("found one field, expected a name and values behind commas");
    return 1;
  }
  const RobotType& known_type(const Metadata& m) const {
    if (m.type == nullptr) table_.fail("found this row before the row \"type\", expected it behind");
    return *m.type;
  }
  const RobotType& type() const {
    const std::string name(table_.field(first()));
    std::vector<std::string> known;
    for (const RobotType& t : robot_types()) {
      if (t.name == name) return t;
      known.push_back(t.name);
    }
    table_.fail(fmt::format("found type \"{}\"{}, expected one of {}", shown(name), did_you_mean(name, known),
                            fmt::join(known, ", ")));
  }
  std::vector<double> numbers(std::size_t expected) const {
    std::size_t found = table_.names().size() - first();
    while (found > 0 && table_.field(found).empty()) --found;
    if (found != expected)
      table_.fail(fmt::format("found {} values of \"{}\", expected {}", found, table_.field(0), expected));
    std::vector<double> values;
    for (std::size_t i = 1; i <= found; ++i) values.push_back(table_.number(i));
    return values;
  }
  std::vector<double> positive(std::size_t expected) const {
    std::vector<double> values = numbers(expected);
    for (const double value : values)
      if (!(value > 0))
        table_.fail(fmt::format("found {} as \"{}\", expected a number > 0", value, table_.field(0)));
    return values;
  }
  std::size_t count() const {
    const double value = positive(1)[0];
    if (value != std::floor(value) || value > kMostRuns)
      table_.fail(fmt::format("found {} as \"{}\", expected a whole number up to {}", value, table_.field(0),
                              kMostRuns));
    return static_cast<std::size_t>(value);
  }

  CsvTable table_;
};

RobotParameter nominal(const std::string& name, double value) {
  RobotParameter p{name, "m", value, 0, 0};
  set_default_box(p);
  return p;
}

}  // namespace

const std::vector<RobotType>& robot_types() {
  using enum SignalKind;
  static const std::vector<RobotType> list = {
      {"diff",
       "differential",
       "differential robot",
       50'000,
       1,
       2,
       {{"n1", "wheel.right", Increment, 1}, {"n2", "wheel.left", Increment, 1}}},
      {"tricyc",
       "tricycle",
       "tricycle with a steered and driven front wheel",
       50'000,
       1,
       1,
       {{"n", "wheel", Increment, 1}, {"delta", "steering", Angle, 1}}},
      {"omni3",
       "omni3",
       "robot with three omni wheels",
       40'000,
       1,
       3,
       {{"n1", "wheel.1", Increment, 1}, {"n2", "wheel.2", Increment, 1}, {"n3", "wheel.3", Increment, 1}}},
      {"omni4",
       "mecanum",
       "robot with four mecanum wheels",
       10'000,
       2,
       4,
       {{"n1", "wheel.1", Increment, 1},
        {"n2", "wheel.2", Increment, -1},
        {"n3", "wheel.3", Increment, 1},
        {"n4", "wheel.4", Increment, -1}}}};
  return list;
}

bool Metadata::same_robot(const Metadata& other) const {
  return type == other.type && distances == other.distances && diameters == other.diameters &&
         steering_zero == other.steering_zero;
}

Metadata parse_metadata(std::string_view text, const std::string& file) {
  return MetadataRows(text, file).read();
}

Robot robot_of(const Metadata& m) {
  std::vector<RobotParameter> list;
  if (m.type->name == "diff") {
    list = {nominal("b", m.distances[0]), nominal("r_right", m.diameters[0] / 2),
            nominal("r_left", m.diameters[1] / 2)};
  } else if (m.type->name == "tricyc") {
    RobotParameter zero{"steering_zero", "rad", m.steering_zero, 0, 0};
    set_default_box(zero);
    list = {nominal("wheelbase", m.distances[0]), nominal("r", m.diameters[0] / 2), zero};
  } else {
    if (m.type->name == "omni3")
      list = {nominal("R", m.distances[0])};
    else
      list = {nominal("lx", m.distances[0] / 2),
              nominal("ly", m.distances[1] / 2),
              {"roller", "rad", kPi / 4, kPi / 4, kPi / 4}};
    for (std::size_t i = 0; i < m.diameters.size(); ++i)
      list.push_back(nominal(fmt::format("r{}", i + 1), m.diameters[i] / 2));
  }
  Robot robot = robot_of_class(m.type->kinematics, list);
  robot.name = fmt::format("OptiOdom's {}", m.type->description);
  return robot;
}

Run parse_run(std::string_view text, const std::string& file, const Metadata& metadata) {
  const RobotType& type = *metadata.type;
  std::vector<std::string> names = {"t", "x", "y", "theta"};
  for (const SensorColumn& s : type.sensors) names.push_back(s.column);
  CsvTable table(text, file, kSeparator, names);

  Run run;
  Recording& r = run.recording;
  for (const SensorColumn& s : type.sensors) r.signals.push_back({s.signal, s.kind, {}});
  while (table.next()) {
    const auto row = static_cast<std::int64_t>(r.size());
    const double t = table.number(0), expected = static_cast<double>(row * type.step_us) / 1e6;
    if (std::abs(t - expected) > 0.25e-6 * static_cast<double>(type.step_us))
      table.fail(fmt::format("found t = {} s in row {}, expected {} s: rows of type {} are {} s apart", t,
                             row + 1, expected, type.name, static_cast<double>(type.step_us) / 1e6));
    r.time_us.push_back(row * type.step_us);
    r.reference.x.push_back(table.number(1));
    r.reference.y.push_back(table.number(2));
    r.reference.theta.push_back(table.number(3));
    for (std::size_t i = 0; i < type.sensors.size(); ++i) {
      const SensorColumn& s = type.sensors[i];
      const double value = table.number(4 + i);
      if (std::abs(value) > kMostMotion)
        table.fail(fmt::format("found {:g} in column \"{}\", expected a motion of at most {:g} in size",
                               value, s.column, kMostMotion));
      const double scale = s.kind == SignalKind::Increment ? 2 * kPi / metadata.counts_per_turn : 1;
      r.signals[i].values.push_back(s.sign * scale * value + 0.0);  // no -0
      if (row == 0 && s.kind == SignalKind::Increment)
        run.before = std::max(run.before, std::abs(scale * value));
    }
  }
  if (r.size() < 2)
    throw DataError(fmt::format("{}:{}: found the end of the file after {} rows, expected at least 2", file,
                                table.line() + 1, r.size()));
  run.unfinished = table.unfinished();
  return run;
}

}  // namespace odobench::optiodom
