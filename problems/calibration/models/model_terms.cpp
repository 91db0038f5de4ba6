#include "problems/calibration/models/model_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "base/names.hpp"
#include "base/text.hpp"

namespace odobench {
namespace {

constexpr std::array kTermHelps = {
    ModelTermHelp{"least_squares", "least-squares twist of steered wheels"},
    ModelTermHelp{"mean", "published mean of the wheels' velocities"},
    ModelTermHelp{"contact_offset",
                  "one offset of the contacts beside the steering axes, left and right mirrored"},
    ModelTermHelp{"contact_offsets", "an offset of its own for each steered wheel"},
    ModelTermHelp{"steering_zeros", "a zero of the steering for each steered wheel"},
    ModelTermHelp{"steering_zero", "the zero of one wheel alone, steering_zero:N"},
    ModelTermHelp{"steering_rate", "contacts beside their axes roll while they are steered"},
    ModelTermHelp{"no_steering_rate", "that they do is neglected"},
    ModelTermHelp{"lever_arm", "place of the tracked frame on the robot"},
    ModelTermHelp{"heading_offset", "yaw of the tracked frame on the robot"},
    ModelTermHelp{"mount", "both, as --mount"},
    ModelTermHelp{"time_offset",
                  "how late the reference is; =SECONDS holds it, :speeds leaves steering as it is"},
    ModelTermHelp{"start_pose", "each drive's start, eliminated"},
    ModelTermHelp{"anchor", "drives start at the reference's first pose"},
    ModelTermHelp{"fixed_layout", "places and angles held at nominal, radii free"},
    ModelTermHelp{"layout_scale", "one factor on all places"},
    ModelTermHelp{"common_radius", "one factor on all radii: the gear"},
    ModelTermHelp{"speed_factor", "one factor on the drives of one kind of recordings, speed_factor:KIND"},
};

[[noreturn]] void refuse_term(const std::string& text, const std::string& why) {
  throw std::invalid_argument(fmt::format("model '{}': {}", shown(text), why));
}

double number_in(const std::string& whole, const std::string& text, bool positive) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value) ||
      (positive && !(value > 0)) || std::abs(value) > 1e3)
    refuse_term(whole, fmt::format("found '{}', expected {}", shown(text),
                                   positive ? "a number above 0 as the half-width of the bounds"
                                            : "a number of seconds"));
  return value;
}

// NAME[=VALUE][:SUFFIX]
struct TermText {
  std::string whole, name, value, suffix;
  bool has_value = false, has_suffix = false;
};

TermText split_term(const std::string& text) {
  TermText t{text, text, "", ""};
  if (const std::size_t colon = t.name.find(':'); colon != std::string::npos) {
    t.suffix = t.name.substr(colon + 1);
    t.name.resize(colon);
    t.has_suffix = true;
  }
  if (const std::size_t equals = t.name.find('='); equals != std::string::npos) {
    t.value = t.name.substr(equals + 1);
    t.name.resize(equals);
    t.has_value = true;
  }
  return t;
}

void read_time_offset(const TermText& t, ModelTerms& terms) {
  if (t.has_value) {
    terms.held_time_offset = number_in(t.whole, t.value, false);
    if (terms.held_time_offset == 0) refuse_term(t.whole, "an offset of 0 changes nothing; leave it out");
    if (std::abs(terms.held_time_offset) > 10)
      refuse_term(t.whole, "found more than 10 s, expected seconds of a lag");
  } else {
    terms.free_time_offset = true;
  }
  if (!t.has_suffix) return;
  if (t.suffix == "speeds")
    terms.shift = ModelTerms::Shift::Speeds;
  else if (t.suffix != "all" && terms.free_time_offset && !t.suffix.empty() && t.suffix[0] < 'A')
    terms.time_bound = number_in(t.whole, t.suffix, true);
  else if (t.suffix != "all")
    refuse_term(t.whole, fmt::format("found ':{}', expected ':speeds' or ':all'", shown(t.suffix)));
}

void contradict(bool both, const char* a, const char* b) {
  if (both) throw std::invalid_argument(fmt::format("model: '{}' and '{}' contradict each other", a, b));
}

// Names that say yes, some with a half-width of their bounds.
void read_flag(const TermText& t, ModelTerms& terms) {
  struct Flag {
    const char* name;
    bool ModelTerms::*value;
    double ModelTerms::*bound;
  };
  constexpr Flag kFlags[] = {{"steering_zeros", &ModelTerms::steering_zeros, &ModelTerms::zero_bound},
                             {"lever_arm", &ModelTerms::lever_arm, &ModelTerms::lever_bound},
                             {"heading_offset", &ModelTerms::heading_offset, &ModelTerms::heading_bound},
                             {"layout_scale", &ModelTerms::layout_scale, &ModelTerms::layout_bound},
                             {"common_radius", &ModelTerms::common_radius, &ModelTerms::radius_bound},
                             {"mount", &ModelTerms::mount, nullptr},
                             {"start_pose", &ModelTerms::start_pose, nullptr},
                             {"anchor", &ModelTerms::anchor, nullptr},
                             {"fixed_layout", &ModelTerms::fixed_layout, nullptr}};
  for (const Flag& flag : kFlags) {
    if (t.name != flag.name) continue;
    terms.*flag.value = true;
    if (!t.has_suffix) return;
    if (flag.bound == nullptr) refuse_term(t.whole, fmt::format("'{}' takes nothing behind a colon", t.name));
    terms.*flag.bound = number_in(t.whole, t.suffix, true);
  }
}

void read_term(const std::string& text, ModelTerms& terms) {
  const TermText t = split_term(text);
  const std::string& name = t.name;
  std::vector<std::string> known;
  for (const ModelTermHelp& help : kTermHelps) known.emplace_back(help.name);
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw std::invalid_argument(fmt::format("unknown model '{}'{}; known: {}", shown(name),
                                            did_you_mean(name, known), fmt::join(known, ", ")));
  if (t.has_value && name != "time_offset") refuse_term(text, "only time_offset is held at a value");
  const auto flag = [&](bool& value, double* bound = nullptr) {
    value = true;
    if (!t.has_suffix) return;
    if (bound == nullptr) refuse_term(text, fmt::format("'{}' takes nothing behind a colon", name));
    *bound = number_in(text, t.suffix, true);
  };
  bool none = false;
  if (name == "least_squares" || name == "mean") {
    const TwistRule rule = name == "mean" ? TwistRule::Mean : TwistRule::LeastSquares;
    contradict(terms.twist.value_or(rule) != rule, "least_squares", "mean");
    terms.twist = rule;
    flag(none);
  } else if (name == "contact_offset" || name == "contact_offsets") {
    const auto kind = name == "contact_offset" ? ModelTerms::Offsets::Shared : ModelTerms::Offsets::Each;
    contradict(terms.offsets != ModelTerms::Offsets::None && terms.offsets != kind, "contact_offset",
               "contact_offsets");
    terms.offsets = kind;
    flag(none, &terms.offset_bound);
  } else if (name == "steering_rate" || name == "no_steering_rate") {
    const bool rate = name == "steering_rate";
    contradict(terms.steering_rate.value_or(rate) != rate, "steering_rate", "no_steering_rate");
    terms.steering_rate = rate;
    flag(none);
  } else if (name == "time_offset") {
    contradict(terms.free_time_offset || terms.held_time_offset != 0, "time_offset", text.c_str());
    read_time_offset(t, terms);
  } else if (name == "speed_factor") {
    if (t.suffix.empty()) refuse_term(text, "expected speed_factor:KIND, a trajectory or how several begin");
    contradict(!terms.speed_factor_of.empty(), "speed_factor", text.c_str());
    terms.speed_factor_of = t.suffix;
  } else if (name == "steering_zero") {
    const bool number = t.suffix.size() == 1 || t.suffix.size() == 2;
    if (!number || t.suffix.find_first_not_of("0123456789") != std::string::npos || t.suffix[0] == '0')
      refuse_term(text, "expected steering_zero:N with the number of a wheel, from 1");
    contradict(terms.zero_of != 0, "steering_zero", text.c_str());
    terms.zero_of = std::stoi(t.suffix);
  } else {
    read_flag(t, terms);
  }
}

std::string with_bound(const char* name, double bound, double usual) {
  return bound == usual ? std::string(name) : fmt::format("{}:{}", name, bound);
}

}  // namespace

bool ModelTerms::beyond_table() const {
  return lever_arm || heading_offset || mount || start_pose || free_time_offset || held_time_offset != 0 ||
         !speed_factor_of.empty() || rates();
}

std::vector<std::string> ModelTerms::names() const {
  const ModelTerms usual;
  std::vector<std::string> list;
  if (twist) list.emplace_back(*twist == TwistRule::Mean ? "mean" : "least_squares");
  if (offsets != Offsets::None)
    list.push_back(with_bound(offsets == Offsets::Shared ? "contact_offset" : "contact_offsets", offset_bound,
                              usual.offset_bound));
  if (steering_zeros) list.push_back(with_bound("steering_zeros", zero_bound, usual.zero_bound));
  if (zero_of != 0) list.push_back(fmt::format("steering_zero:{}", zero_of));
  if (steering_rate) list.emplace_back(*steering_rate ? "steering_rate" : "no_steering_rate");
  if (lever_arm) list.push_back(with_bound("lever_arm", lever_bound, usual.lever_bound));
  if (heading_offset) list.push_back(with_bound("heading_offset", heading_bound, usual.heading_bound));
  if (mount) list.emplace_back("mount");
  if (free_time_offset || held_time_offset != 0) {
    std::string text = "time_offset";
    if (!free_time_offset) text += fmt::format("={}", held_time_offset);
    if (shift == Shift::Speeds) text += ":speeds";
    if (free_time_offset && shift == Shift::All)
      text = with_bound("time_offset", time_bound, usual.time_bound);
    list.push_back(text);
  }
  if (start_pose) list.emplace_back("start_pose");
  if (anchor) list.emplace_back("anchor");
  if (fixed_layout) list.emplace_back("fixed_layout");
  if (layout_scale) list.push_back(with_bound("layout_scale", layout_bound, usual.layout_bound));
  if (common_radius) list.push_back(with_bound("common_radius", radius_bound, usual.radius_bound));
  if (!speed_factor_of.empty()) list.push_back("speed_factor:" + speed_factor_of);
  return list;
}

std::string ModelTerms::text() const {
  return fmt::format("{}", fmt::join(names(), "+"));
}

std::span<const ModelTermHelp> model_term_helps() {
  return kTermHelps;
}

ModelTerms model_terms(const std::vector<std::string>& names) {
  ModelTerms terms;
  std::vector<std::string> seen;
  for (const std::string& name : names) {
    if (std::find(seen.begin(), seen.end(), name) != seen.end())
      throw std::invalid_argument(fmt::format("model '{}' is named twice", shown(name)));
    seen.push_back(name);
    read_term(name, terms);
  }
  contradict(terms.steering_zeros && terms.zero_of != 0, "steering_zeros", "steering_zero");
  contradict(terms.mount && terms.lever_arm, "mount", "lever_arm");
  contradict(terms.mount && terms.heading_offset, "mount", "heading_offset");
  contradict(terms.fixed_layout && terms.layout_scale, "fixed_layout", "layout_scale");
  contradict(terms.start_pose && terms.anchor, "start_pose", "anchor");
  return terms;
}

}  // namespace odobench
