#include "bench/studies/importing/log_proposal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "base/angle.hpp"
#include "base/text.hpp"
#include "bench/studies/importing/clock_offset.hpp"
#include "bench/studies/importing/wheel_evidence.hpp"
#include "datasets/csv/column_name.hpp"
#include "datasets/import/logs/log_import.hpp"
#include "datasets/import/logs/log_roles.hpp"
#include "datasets/robots/layouts.hpp"

namespace odobench {
namespace {

using MapJson = nlohmann::ordered_json;
using log_import::LogCurves;
using log_import::LogMap;
using log_import::Role;
using log_import::Roles;
using log_import::SurveyedSource;

constexpr int kStandInCounts = 1000;  // per turn, while nobody has said it

MapJson text_or_null(const std::string& text) {
  return text.empty() ? MapJson(nullptr) : MapJson(text);
}

// A map is text: what it could not name is left out.
std::vector<SurveyedSource> nameable(std::vector<SurveyedSource> sources) {
  std::erase_if(sources, [](const SurveyedSource& s) {
    return !is_valid_utf8(s.source.name) || !is_valid_utf8(s.files);
  });
  for (SurveyedSource& s : sources)
    std::erase_if(s.source.fields, [](const LogField& f) { return !is_valid_utf8(f.path); });
  return sources;
}

class Proposer {
 public:
  Proposer(const std::vector<std::filesystem::path>& logs, const LogOptions& options, const Stop& stop,
           const std::string& robot)
      : logs_(logs),
        options_(options),
        stop_(stop),
        sources_(nameable(log_import::survey_logs(logs, options, stop))),
        roles_(find_roles(sources_, robot)) {
    for (const auto* list : {&roles_.wheels, &roles_.steering, &roles_.reference, &roles_.gyro})
      for (const Role& role : *list) name_source(role.source);
    for (const Role& role : roles_.wheels) signs_[role.which] = 1;
  }

  LogProposal propose() {
    LogProposal out;
    headings_ = roles_.reference.empty() && !roles_.gyro.empty();
    out.complete = !roles_.kinematics.empty() && (headings_ || roles_.reference.size() == 3);
    if (headings_)
      say("reference: the gyro, for want of poses: headings alone, which tell ratios of lengths and no "
          "length");
    if (out.complete && headings_)
      look_at_turns();
    else if (out.complete)
      look_at_drives();
    for (const SurveyedSource& source : sources_)
      if (!names_.contains(number(source)) && source.source.unreadable.empty())
        unused_.push_back(
            shown(source.source.name.empty() ? source.file.filename().string() : source.source.name));
    out.map = map(false).dump(2) + "\n";
    out.reasons = std::move(roles_.reasons);
    if (!unused_.empty()) out.reasons.push_back(fmt::format("not used: {}", fmt::join(unused_, ", ")));
    return out;
  }

 private:
  std::size_t number(const SurveyedSource& source) const {
    return static_cast<std::size_t>(&source - sources_.data());
  }
  void say(std::string text) { roles_.reasons.push_back(std::move(text)); }

  // "wheel_ticks" of "/robot/wheel_ticks"; of a table the file's name.
  void name_source(std::size_t number) {
    if (names_.contains(number)) return;
    const SurveyedSource& source = sources_[number];
    std::string name = source.source.name.substr(source.source.name.find_last_of('/') + 1);
    if (name.empty()) name = sources_.size() == 1 ? "table" : source.file.stem().string();
    name = printable(name);
    while (std::any_of(names_.begin(), names_.end(), [&](const auto& other) { return other.second == name; }))
      name += '_';
    names_[number] = name;
  }

  MapJson sources() const {
    MapJson all = MapJson::object();
    for (const auto& [number, name] : names_) {
      const SurveyedSource& surveyed = sources_[number];
      MapJson source = MapJson::object();
      if (!surveyed.source.name.empty()) source["topic"] = surveyed.source.name;
      if (!surveyed.files.empty()) source["files"] = surveyed.files;
      for (const LogField& field : surveyed.source.fields)
        if (field.path == "header.stamp") source["time"] = "header.stamp";
      if (offset_ && !headings_ && number == roles_.reference.front().source) source["offset_s"] = "estimate";
      all[name] = std::move(source);
    }
    return all;
  }

  MapJson of(const Role& role) const {
    MapJson json = {{"source", names_.at(role.source)}};
    if (role.quaternion.empty())
      json["field"] = role.field;
    else
      json["quaternion"] = role.quaternion;
    return json;
  }

  // `stand_in`: with numbers where only the user knows.
  MapJson signals(bool stand_in) const {
    MapJson all = MapJson::object();
    for (const Role& role : roles_.wheels) {
      MapJson json = of(role);
      json["unit"] = text_or_null(role.unit);
      if (role.unit == "count") json["per_turn"] = stand_in ? MapJson(kStandInCounts) : MapJson(nullptr);
      if (const auto bits = bits_.find(role.field); bits != bits_.end()) json["bits"] = bits->second;
      if (role.kind == "travel") json["radius"] = stand_in ? MapJson(1.0) : MapJson(nullptr);
      if (const int sign = signs_.at(role.which); sign < 0) json["sign"] = sign;
      const char* head = role.kind == "speed"    ? "wheel_speed"
                         : role.kind == "travel" ? "wheel_travel"
                                                 : "wheel_angle";
      all[role.which.empty() ? std::string(head) : fmt::format("{}.{}", head, role.which)] = std::move(json);
    }
    for (const Role& role : roles_.steering) {
      MapJson json = of(role);
      json["unit"] = text_or_null(role.unit.empty() && stand_in ? "rad" : role.unit);
      if (role.unit == "count") json["per_turn"] = stand_in ? MapJson(kStandInCounts) : MapJson(nullptr);
      all[role.which.empty() ? std::string("steering") : "steering." + role.which] = std::move(json);
    }
    for (const Role& role : roles_.reference) {
      MapJson json = of(role);
      json["unit"] = role.unit;
      if ((role.which == "y" && mirrored_) || (role.which == "heading" && z_down_)) json["sign"] = -1;
      all["reference." + role.which] = std::move(json);
    }
    for (const Role& role : roles_.gyro) {
      MapJson json = of(role);
      json["unit"] = role.unit;
      if (gyro_sign_ < 0) json["sign"] = -1;
      if (!headings_) json["optional"] = true;
      all["gyro.z"] = std::move(json);
    }
    return all;
  }

  MapJson robot(bool stand_in) const {
    MapJson parameters = MapJson::array();
    if (!roles_.kinematics.empty())
      for (const BoundParameter& p : robots::make_robot(robots::layout(roles_.kinematics)).parameters)
        parameters.push_back(
            {{"name", p.parameter.name},
             {"nominal",
              p.parameter.unit == "m" && !stand_in ? MapJson(nullptr) : MapJson(p.parameter.nominal)}});
    return {
        {"name", "my_robot"}, {"kinematics", text_or_null(roles_.kinematics)}, {"parameters", parameters}};
  }

  MapJson map(bool stand_in) const {
    MapJson all = {{"schema", "odobench-import"}, {"schema_version", 1}, {"name", "my_robot"}};
    all["robot"] = robot(stand_in);
    all["sources"] = sources();
    all["signals"] = signals(stand_in);
    if (roles_.drifts) all["reference"] = "drifting";
    if (mount_ && !stand_in) all["mount"] = "estimate";
    all["drives"] = {{"split", "standstill"}, {"standstill_s", 3.0}};
    all["limits"] = {{"max_gap_s", 0.2}};
    return all;
  }

  // The first drive, by the map as it stands.
  std::pair<LogMap, LogCurves> first_drive() const {
    LogMap own = log_import::parse_log_map(map(true).dump(), "proposal");
    LogCurves read = read_curves(own, group_logs(own, logs_).front(), options_, stop_);
    return {std::move(own), std::move(read)};
  }

  // Counters that run over jump by 2^16 or 2^32 where they otherwise step by little.
  bool find_counters(const LogMap& own, const LogCurves& read) {
    constexpr double kCount = 2 * kPi / kStandInCounts;
    std::optional<CounterJumps> found;
    for (const log_import::Curve& signal : read.signals)
      if (const auto jumps = counter_jumps(signal, kCount)) found = jumps;
    if (!found) return false;
    for (std::size_t i = 0; i < own.signals.size(); ++i) {
      const log_import::MappedSignal& signal = own.signals[i];
      if (signal.format.unit != "count" || signal.format.kind != SignalFormat::Kind::Position) continue;
      const auto jumps = counter_jumps(read.signals[i], kCount);
      if (jumps) found = jumps;
      bits_[signal.at.field] = found->bits;
      say(fmt::format("{}: a counter of {} bits, which runs over ({} jumps): \"bits\": {}",
                      signal.format.name, found->bits, jumps ? jumps->count : 0, found->bits));
    }
    return !bits_.empty();
  }

  void look_at_drives() {
    auto [own, read] = first_drive();
    if (find_counters(own, read)) std::tie(own, read) = first_drive();
    const bool clocks = roles_.wheels.front().source != roles_.reference.front().source;
    std::optional<ClockOffset> offset = clock_offset(own, read);
    if (roles_.kinematics == "differential") {
      // One wheel that counts backwards would take its turns for distances.
      LogCurves other = read;
      for (double& v : other.signals.front().value) v = -v;
      const std::optional<ClockOffset> turned = clock_offset(own, other);
      if (turned && (!offset || turned->correlation > offset->correlation)) offset = turned;
      if (!offset && clocks)
        say("no turn that wheels and reference share: sides, signs and clocks not checked");
      if (offset || !clocks) weigh_pair(read, clocks ? offset->seconds : 0);
    }
    mount_ = offset.has_value();
    say(mount_ ? "mount of the tracked frame: \"estimate\", by the drives' turns; give x, y, yaw_deg if you "
                 "know them"
               : "mount of the tracked frame: taken as 0, since the drives do not turn enough to tell it");
    if (!clocks) return;
    offset_ = offset.has_value();
    if (offset)
      say(fmt::format(
          "clock of the reference runs {:.3f} s ahead of the wheels (correlation {:.4f}): \"estimate\"",
          offset->seconds, offset->correlation));
  }

  // Which way the wheels turn the robot, by the gyro.
  void look_at_turns() {
    auto [own, read] = first_drive();
    if (find_counters(own, read)) std::tie(own, read) = first_drive();
    if (roles_.kinematics != "differential") return;
    const std::optional<TurnEvidence> found = turn_evidence(read);
    if (!found) return say("no turns that wheels and gyro share: signs not checked");
    std::map<std::string, double> side;
    for (std::size_t i = 0; i < 2; ++i)
      side[read.signals[i].name.substr(read.signals[i].name.find('.') + 1)] = found->share[i];
    if (side["right"] < 0 && side["left"] > 0) {
      gyro_sign_ = -1;
      say("gyro: turns against the wheels: taken to hang upside down (sign -); or both wheels count "
          "backwards, or "
          "left is right");
    } else {
      for (const char* which : {"right", "left"})
        if ((side[which] < 0) == (which == std::string("right"))) signs_[which] = -1;
    }
    for (const char* which : {"right", "left"})
      say(fmt::format("{}: sign {} by the gyro ({:.2f} % of its turns explained)", which,
                      signs_[which] < 0 ? '-' : '+', 100 * found->explained));
  }

  // A frame whose y grows to the right, or whose x and y are exchanged, explains nothing until it is turned
  // over.
  void unmirror(const LogCurves& read, double offset, std::vector<WheelEvidence>& found) {
    constexpr double kPoor = 0.93, kGood = 0.97;  // of what is explained
    const auto worst = [](const std::vector<WheelEvidence>& all) {
      double least = 1;
      for (const WheelEvidence& e : all) least = std::min(least, e.explained);
      return least;
    };
    if (worst(found) > kPoor) return;
    LogCurves other = read;
    for (double& v : other.y.value) v = -v;
    std::vector<WheelEvidence> turned = wheel_evidence(other, offset);
    if (turned.size() != found.size() || worst(turned) < kGood) return;
    found = std::move(turned);
    mirrored_ = true;
    say("the reference's frame is mirrored (y grows to the right, or x and y are exchanged): y is taken with "
        "sign -");
  }

  // Whether a gyro in the log says the opposite of the reference's turns.
  static bool turns_against_gyro(const LogCurves& read, double offset) {
    constexpr double kStep = 0.1, kSure = 0.8;
    for (const log_import::Curve& gyro : read.others) {
      if (gyro.name != "gyro.z") continue;
      double both = 0, own = 0, other = 0;
      std::size_t h = 0, g = 0;
      for (double t = gyro.time.front(); t + kStep < gyro.time.back(); t += kStep) {
        const double before = read.heading.at(t + offset, h);
        const double turned = (read.heading.at(t + kStep + offset, h) - before) / kStep;
        const double rate = gyro.at(t + kStep / 2, g);
        both += turned * rate, own += turned * turned, other += rate * rate;
      }
      return both < -kSure * std::sqrt(own * other);
    }
    return false;
  }

  // Whether the wheels' names are right, in a frame that looks ahead or back.
  static bool as_named(const LogCurves& read, const std::vector<WheelEvidence>& found) {
    const bool left_first = read.signals.front().name.ends_with("left");
    const WheelEvidence &left = found[left_first ? 0 : 1], &right = found[left_first ? 1 : 0];
    const bool forward = left.along > 0 && right.along > 0, back = left.along < 0 && right.along < 0;
    return (forward && left.side() < right.side()) || (back && left.side() > right.side());
  }

  // Wheels that are wrong by the reference and right by the gyro: the reference's z points down.
  void turn_over(const LogCurves& read, double offset, std::vector<WheelEvidence>& found) {
    if (roles_.by_place || mirrored_ || as_named(read, found) || !turns_against_gyro(read, offset)) return;
    LogCurves other = read;
    for (double& v : other.y.value) v = -v;
    for (double& v : other.heading.value) v = -v;
    const std::vector<WheelEvidence> turned = wheel_evidence(other, offset);
    if (turned.size() != found.size() || !as_named(other, turned)) return;
    found = turned;
    mirrored_ = z_down_ = true;
    say("the reference turns against gyro and wheels: its frame is mirrored (z down): y and heading are "
        "taken with "
        "sign -");
  }

  void weigh_pair(const LogCurves& read, double offset) {
    std::vector<WheelEvidence> found = wheel_evidence(read, offset);
    if (found.size() != roles_.wheels.size()) return;
    unmirror(read, offset, found);
    turn_over(read, offset, found);
    // The curves stand in the robot's order, the roles in the log's.
    std::map<std::string, WheelEvidence> by_side;
    const auto sort_sides = [&] {
      for (std::size_t i = 0; i < found.size(); ++i)
        by_side[read.signals[i].name.substr(read.signals[i].name.find('.') + 1)] = found[i];
    };
    sort_sides();
    // Both backwards and exchanged is what a frame that looks backwards makes of right names.
    if (!roles_.by_place && found[0].along < 0 && found[1].along < 0 &&
        by_side["left"].side() > by_side["right"].side()) {
      for (WheelEvidence& e : found) e.along = -e.along;
      sort_sides();
      say("the tracked frame looks backwards on the robot, or both wheels count backwards and left is right");
    }
    const bool swapped = by_side["left"].side() > by_side["right"].side();
    for (Role& role : roles_.wheels) {
      const WheelEvidence& e = by_side[role.which];
      if (swapped) role.which = role.which == "left" ? "right" : "left";
      signs_[role.which] = e.along < 0 ? -1 : 1;
      const double radius = 1 / std::abs(e.along);
      say(fmt::format("{}: {} of the reference's motion explained; sign {}; {}", role.which,
                      fmt::format("{:.2f} %", 100 * e.explained), e.along < 0 ? '-' : '+',
                      role.unit == "count"
                          ? fmt::format("{:.6g} m a count: {:.0f} counts a turn at a radius of 0.05 m",
                                        radius * 2 * kPi / kStandInCounts, kStandInCounts * 0.05 / radius)
                          : fmt::format("radius about {:.4f} m", radius)));
      if (role.unit == "rad" && (radius > 3 || radius < 0.003))
        say(fmt::format("{}: a radius of {:.3g} m: is the unit right?", role.which, radius));
    }
    if (swapped)
      say(roles_.by_place ? "left and right: as the turns say, the other way round than they stand"
                          : "left and right: the turns say that the names are the wrong way round: exchanged "
                            "(or the reference's "
                            "frame is mirrored, y to the right: then undo it)");
    const double track = std::abs(by_side["left"].side() - by_side["right"].side());
    say(fmt::format("distance of the wheels about {:.3f} m", track));
  }

  const std::vector<std::filesystem::path>& logs_;
  const LogOptions& options_;
  const Stop& stop_;
  std::vector<SurveyedSource> sources_;
  Roles roles_;
  std::map<std::size_t, std::string> names_;
  std::map<std::string, int> signs_;
  std::vector<std::string> unused_;
  std::map<std::string, int> bits_;  // of counters, by field
  bool offset_ = false, mount_ = false, headings_ = false, mirrored_ = false, z_down_ = false;
  int gyro_sign_ = 1;
};

}  // namespace

LogProposal propose_log_map(const std::vector<std::filesystem::path>& logs, const LogOptions& options,
                            const Stop& stop, const std::string& robot) {
  return Proposer(logs, options, stop, robot).propose();
}

}  // namespace odobench
