#include "datasets/native/signal_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angle.hpp"
#include "base/text.hpp"

namespace odobench {
namespace {

using Kind = SignalFormat::Kind;

constexpr std::array<std::string_view, 5> kKinds = {"speed", "increment", "angle", "position", "travel"};

struct Unit {
  std::string_view name;
  double scale;
};
constexpr std::array<Unit, 4> kSpeeds = {
    {{"rad/s", 1}, {"rpm", kPi / 30}, {"deg/s", kDegree}, {"turn/s", 2 * kPi}}};
constexpr std::array<Unit, 3> kLengths = {{{"m", 1}, {"cm", 0.01}, {"mm", 0.001}}};
constexpr std::array<Unit, 3> kAngles = {{{"rad", 1}, {"deg", kDegree}, {"turn", 2 * kPi}}};

template <class Units>
double scale_of(const JsonNode& node, const std::string& unit, const Units& units, const char* expected) {
  for (const Unit& known : units)
    if (known.name == unit) return known.scale;
  node.fail('"' + shown(unit) + '"', expected);
}

// What is divided by: no gear, no wheel is beyond these limits.
double positive(const JsonNode& node) {
  const double value = node.number();
  if (!(value >= 1e-6) || !(value <= 1e12))
    node.fail(fmt::format("{}", value), "a number above 0, from 1e-6 to 1e12");
  return value;
}

double unit_scale(const JsonNode& node, const SignalFormat& format) {
  if (format.kind == Kind::Travel)
    return scale_of(node.at("unit"), format.unit, kLengths, "\"m\", \"cm\" or \"mm\"") /
           positive(node.at("radius"));
  if (format.kind == Kind::Speed)
    return scale_of(node.at("unit"), format.unit, kSpeeds, "\"rad/s\", \"rpm\", \"deg/s\" or \"turn/s\"");
  if (format.unit == "count") return 2 * kPi / positive(node.at("per_turn"));
  return scale_of(node.at("unit"), format.unit, kAngles, "\"rad\", \"deg\", \"turn\" or \"count\"");
}

}  // namespace

SignalKind SignalFormat::signal_kind() const {
  if (kind == Kind::Speed) return SignalKind::Speed;
  return kind == Kind::Angle ? SignalKind::Angle : SignalKind::Increment;
}

bool SignalFormat::plain() const {
  return kind != Kind::Position && kind != Kind::Travel && scale == 1;
}

namespace {

Kind kind_of(const JsonNode& node) {
  const std::string kind = node.text();
  const auto found = std::find(kKinds.begin(), kKinds.end(), kind);
  if (found == kKinds.end())
    node.fail('"' + shown(kind) + '"', "\"speed\", \"increment\", \"angle\", \"position\" or \"travel\"");
  return static_cast<Kind>(found - kKinds.begin());
}

}  // namespace

SignalFormat read_signal_format(const JsonNode& node) {
  node.allow_only({"name", "kind", "unit", "per_turn", "bits", "sign", "radius"});
  const std::string name = node.at("name").text();
  SignalFormat format = read_signal_kind(node);
  format.name = name;
  return format;
}

SignalFormat read_signal_kind(const JsonNode& node, std::optional<Kind> otherwise) {
  SignalFormat format;
  format.kind = otherwise && !node.has("kind") ? *otherwise : kind_of(node.at("kind"));
  const std::string kind(kKinds[static_cast<std::size_t>(format.kind)]);
  format.unit = node.at("unit").text();
  format.scale = unit_scale(node, format);
  if (node.has("per_turn") && format.unit != "count")
    node.at("per_turn").fail(fmt::format("a unit of \"{}\"", shown(format.unit)), "it with counts only");
  if (node.has("radius") && format.kind != Kind::Travel)
    node.at("radius").fail(fmt::format("a signal of kind \"{}\"", kind), "it with travel only");
  if (node.has("bits")) {
    if (format.kind != Kind::Position || format.unit != "count")
      node.at("bits").fail(fmt::format("a signal of kind \"{}\" in {}", kind, shown(format.unit)),
                           "it with positions in counts only");
    const std::int64_t bits = node.at("bits").integer();
    if (bits < 4 || bits > 52) node.at("bits").fail(fmt::format("{}", bits), "4 to 52");
    format.bits = static_cast<int>(bits);
  }
  if (node.has("sign")) {
    const std::int64_t sign = node.at("sign").integer();
    if (sign != 1 && sign != -1) node.at("sign").fail(fmt::format("{}", sign), "1 or -1");
    format.scale *= static_cast<double>(sign);
  }
  return format;
}

SignalFormat format_of(const Signal& signal) {
  SignalFormat format;
  format.name = signal.name;
  format.kind = signal.kind == SignalKind::Speed   ? Kind::Speed
                : signal.kind == SignalKind::Angle ? Kind::Angle
                                                   : Kind::Increment;
  format.unit = unit_of(signal.kind);
  return format;
}

std::optional<std::size_t> beyond_counter(const SignalFormat& format, const std::vector<double>& values) {
  if (format.bits == 0) return std::nullopt;
  const double most = std::ldexp(1.0, format.bits);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!(std::abs(values[k]) <= most)) return k;
  return std::nullopt;
}

void convert(const SignalFormat& format, std::vector<double>& values) {
  if (format.kind == Kind::Position || format.kind == Kind::Travel) {
    // Backwards, so that each entry still finds the one before.
    for (std::size_t k = values.size(); k-- > 1;) {
      double difference = values[k] - values[k - 1];
      if (format.bits > 0) difference = std::remainder(difference, std::ldexp(1.0, format.bits));
      values[k] = difference;
    }
    if (!values.empty()) values[0] = 0;
  }
  if (format.scale != 1)
    for (double& value : values) value *= format.scale;
}

}  // namespace odobench
