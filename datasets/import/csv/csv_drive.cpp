#include "datasets/import/csv/csv_drive.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/angle.hpp"
#include "base/names.hpp"
#include "base/range.hpp"
#include "base/text.hpp"
#include "datasets/csv/csv_table.hpp"
#include "datasets/csv/decimal_time.hpp"
#include "datasets/native/columns.hpp"

namespace odobench::csv_import {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr double kLargestCount = 9007199254740992;  // 2^53: larger ones are not exact in a double

CsvTable open_table(std::string_view text, const std::string& file, const CsvMap& map) {
  if (map.columns.empty()) return CsvTable(text, file, ',');
  if (text.substr(0, 3) == kByteOrderMark) text.remove_prefix(3);
  return CsvTable(text, file, map.separator, map.columns);
}

void require_header(const CsvTable& table) {
  const std::vector<std::string>& names = table.names();
  if (!std::all_of(names.begin(), names.end(), [](const std::string& n) { return looks_like_number(n); }))
    return;
  throw DataError(
      fmt::format("{}:{}: found numbers, expected the names of the columns; where files have none, give "
                  "\"csv\": {{\"columns\": [...]}} in the map",
                  shown(table.file(), 400), table.header_line()));
}

// The nearest name, or the first that begins in the same way.
std::string nearest_column(const std::string& wanted, const std::vector<std::string>& names) {
  constexpr std::size_t kBeginning = 3;
  if (const std::string said = did_you_mean(wanted, names); !said.empty() || wanted.size() < kBeginning)
    return said;
  for (const std::string& name : names)
    if (name.starts_with(wanted.substr(0, kBeginning)))
      return fmt::format(", did you mean '{}'?", shown(name));
  return "";
}

std::size_t find_column(const CsvTable& table, const MappedColumn& wanted, const CsvMap& map) {
  const std::vector<std::string>& names = table.names();
  const auto found = std::find(names.begin(), names.end(), wanted.column);
  if (found == names.end()) {
    std::vector<std::string> there;
    for (const std::string& name : names)
      if (there.size() < 12) there.push_back(shown(name, 30));
    throw DataError(fmt::format("{}:{}: found no column \"{}\" ({}: {}){}; there are {}{}", table.file(),
                                table.header_line(), shown(wanted.column), map.file, shown(wanted.place),
                                nearest_column(wanted.column, names), fmt::join(there, ", "),
                                names.size() > there.size() ? ", ..." : ""));
  }
  return table.column(wanted.column);  // which refuses one that stands twice
}

bool is_missing(std::string_view field) {
  return field.empty() || (field.size() == 3 && (field[0] | 0x20) == 'n' && (field[1] | 0x20) == 'a' &&
                           (field[2] | 0x20) == 'n');
}

class DriveReader {
 public:
  DriveReader(std::string_view text, const std::string& file, const CsvMap& map)
      : table_(open_table(text, file, map)), map_(map) {
    if (map.columns.empty()) require_header(table_);
    time_ = find_column(table_, map.time, map);
    const MappedColumn* const pose[] = {&map.x, &map.y, &map.theta};
    for (std::size_t i = 0; i < 3; ++i) pose_[i] = find_column(table_, *pose[i], map);
    for (const MappedSignal& signal : map.signals) {
      signals_.push_back(find_column(table_, signal.at, map));
      drive_.recording.signals.push_back({signal.format.name, signal.format.signal_kind(), {}});
    }
  }

  CsvDrive read() {
    while (table_.next()) {
      take_stamp();
      take_pose();
      for (std::size_t i = 0; i < signals_.size(); ++i)
        drive_.recording.signals[i].values.push_back(value(i));
      lines_.push_back(table_.line());
    }
    drive_.unfinished = table_.unfinished();
    Recording& r = drive_.recording;
    for (std::size_t i = 0; i < signals_.size(); ++i) convert(map_.signals[i].format, r.signals[i].values);
    cut_beginning();
    for (const std::int64_t stamp : stamps_) r.time_us.push_back(rounded_us(stamp - stamps_.front()));
    unwrap();
    drop_missing_reference(r);
    check();
    measure_steps();
    return std::move(drive_);
  }

 private:
  static std::int64_t rounded_us(std::int64_t ns) { return (ns + 500) / 1000; }

  void take_stamp() {
    const std::string_view field = table_.field(time_);
    const std::optional<std::int64_t> stamp = decimal_nanoseconds(field, map_.time_digits);
    if (!stamp)
      table_.fail(
          fmt::format("found \"{}\" in column \"{}\", expected a time as a decimal number of at most "
                      "4e9 s",
                      shown(field), shown(map_.time.column)));
    if (!stamps_.empty()) {
      const double step = static_cast<double>(*stamp - stamps_.back()) * 1e-9;
      if (step < 0)
        table_.fail(fmt::format("time goes back by {:.6g} s, expected a later stamp than in line {}", -step,
                                lines_.back()));
      if (*stamp - stamps_.back() < 1000)  // two stamps of whole microseconds must differ
        table_.fail(
            fmt::format("found the stamp \"{}\" {:.3g} us after that of line {}, expected 1 us at least",
                        shown(field), step * 1e6, lines_.back()));
    }
    stamps_.push_back(*stamp);
  }

  void take_pose() {
    Reference& reference = drive_.recording.reference;
    std::vector<double>* const to[] = {&reference.x, &reference.y, &reference.theta};
    const double scale[] = {map_.x.scale, map_.y.scale, map_.theta.scale};
    std::size_t missing = 0;
    for (const std::size_t column : pose_) missing += is_missing(table_.field(column)) ? 1 : 0;
    if (missing > 0 && missing < 3)
      table_.fail(fmt::format("found {} of x, y and theta empty, expected all three or none", missing));
    for (std::size_t i = 0; i < 3; ++i)
      to[i]->push_back(missing == 0 ? table_.number(pose_[i]) * scale[i] : kNotANumber);
  }

  double value(std::size_t i) const {
    const double value = table_.number(signals_[i]);
    if (map_.signals[i].format.unit == "count" && std::abs(value) > kLargestCount)
      table_.fail(fmt::format("found \"{}\" in column \"{}\", expected counts of at most 2^53",
                              shown(table_.field(signals_[i])), shown(table_.name(signals_[i]))));
    return value;
  }

  // A drive begins with a pose that is known.
  void cut_beginning() {
    Recording& r = drive_.recording;
    const auto first = static_cast<std::size_t>(
        std::find_if(r.reference.x.begin(), r.reference.x.end(), [](double x) { return !std::isnan(x); }) -
        r.reference.x.begin());
    if (first == stamps_.size() && first > 0)
      throw DataError(
          fmt::format("{}:{}: found no row with {}, {} and {}, expected a reference in two rows at "
                      "least",
                      table_.file(), table_.line(), shown(map_.x.column), shown(map_.y.column),
                      shown(map_.theta.column)));
    const auto cut = [first](auto& values) {
      values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first));
    };
    drive_.before_reference = first;
    cut(stamps_);
    cut(lines_);
    cut(r.reference.x);
    cut(r.reference.y);
    cut(r.reference.theta);
    for (Signal& signal : r.signals) {
      cut(signal.values);
      if (signal.kind == SignalKind::Increment && !signal.values.empty() && first == 0)
        drive_.first_increment = std::max(drive_.first_increment, std::abs(signal.values[0]));
    }
    if (stamps_.size() < 2)
      throw DataError(fmt::format("{}:{}: found {} rows{}, expected at least 2", table_.file(), table_.line(),
                                  stamps_.size(), first > 0 ? " from the first with a reference on" : ""));
  }

  // Between rows that follow each other more than half a turn is a jump; over rows without a reference nobody
  // knows.
  void unwrap() {
    std::vector<double>& theta = drive_.recording.reference.theta;
    double turns = 0, previous = theta[0];
    std::size_t last = 0;
    for (std::size_t k = 1; k < theta.size(); ++k) {
      if (std::isnan(theta[k])) continue;
      const double raw = theta[k], jump = std::round((raw - previous) / (2 * kPi));
      if (jump != 0 && k == last + 1) {
        turns -= jump;
        ++drive_.turns_removed;
      } else if (jump != 0) {
        ++drive_.unclear_turns;
      }
      theta[k] = raw + turns * (2 * kPi);
      previous = raw;
      last = k;
    }
  }

  void check() {
    const Recording& r = drive_.recording;
    if (const auto fault = find_fault(r, 2)) {
      const std::size_t line = fault->sample ? lines_[*fault->sample] : table_.header_line();
      throw DataError(fmt::format("{}:{}: {}: {}", table_.file(), line, fault->column, fault->what));
    }
    if (r.reference.sample.empty()) return;
    drive_.without_reference = r.size() - r.reference.sample.size();
    if (r.reference.sample.size() < 2)
      throw DataError(fmt::format("{}:{}: found one row with a reference, expected another after it",
                                  table_.file(), lines_.front()));
  }

  void measure_steps() {
    std::vector<std::int64_t> steps;
    for (std::size_t k = 1; k < stamps_.size(); ++k) steps.push_back(stamps_[k] - stamps_[k - 1]);
    const auto longest = std::max_element(steps.begin(), steps.end());
    drive_.longest_step = static_cast<double>(*longest) * 1e-9;
    drive_.longest_line = lines_[static_cast<std::size_t>(longest - steps.begin()) + 1];
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    drive_.usual_step = static_cast<double>(*middle) * 1e-9;
    for (const std::int64_t step : steps)
      drive_.gaps += static_cast<double>(step) * 1e-9 > kGap * drive_.usual_step ? 1 : 0;
  }

  CsvTable table_;
  const CsvMap& map_;
  CsvDrive drive_;
  std::size_t time_ = 0, pose_[3] = {};
  std::vector<std::size_t> signals_;
  std::vector<std::size_t> lines_;
  std::vector<std::int64_t> stamps_;  // ns
};

}  // namespace

CsvDrive parse_drive(std::string_view text, const std::string& file, const CsvMap& map) {
  return DriveReader(text, file, map).read();
}

Travelled travelled(const Reference& reference) {
  constexpr double kMove = 0.01, kTurn = kDegree;
  Travelled t;
  if (reference.x.empty()) return t;
  double x = reference.x[0], y = reference.y[0], theta = reference.theta[0];
  for (std::size_t k = 1; k < reference.x.size(); ++k) {
    const bool end = k + 1 == reference.x.size();
    const double moved = std::hypot(reference.x[k] - x, reference.y[k] - y);
    if (moved >= kMove) {
      t.metres += moved;
      x = reference.x[k];
      y = reference.y[k];
    }
    const double turned = reference.theta[k] - theta;
    if (std::abs(turned) < kTurn && !(end && (t.left > 0 || t.right > 0))) continue;
    (turned > 0 ? t.left : t.right) += std::abs(turned);
    theta = reference.theta[k];
  }
  return t;
}

std::string describe_drive(const Recording& r, const std::string& file) {
  const Travelled t = travelled(r.reference);
  return fmt::format("{}{}: {} samples, {:.2f} s, {:.2f} m, {:.1f} deg to the left, {:.1f} deg to the right",
                     r.id, file.empty() ? "" : " (" + file + ")", r.size(),
                     static_cast<double>(r.time_us.back()) * 1e-6, t.metres, t.left / kDegree,
                     t.right / kDegree);
}

}  // namespace odobench::csv_import
