#include "datasets/csv/column_name.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <utility>
#include <vector>

namespace odobench {
namespace {

using Words = std::vector<std::string>;

// The micro sign or the Greek letter, both of two bytes in UTF-8.
bool is_micro(std::string_view text) {
  return text.substr(0, 2) == "\xC2\xB5" || text.substr(0, 2) == "\xCE\xBC";
}

// Letters, digits and what else a unit has, in lower case; words end where letters meet digits, too.
Words words_of(std::string_view text) {
  Words words;
  bool new_word = true, digit = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (is_micro(text.substr(i))) {
      c = 'u';
      ++i;
    }
    const auto u = static_cast<unsigned char>(c);
    if (u >= 0x80 || std::isalnum(u) == 0) {
      new_word = true;
      continue;
    }
    const bool is_digit = std::isdigit(u) != 0;
    if (new_word || is_digit != digit) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(u));
    new_word = false;
    digit = is_digit;
  }
  return words;
}

bool has(const Words& words, std::initializer_list<std::string_view> known) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::find(known.begin(), known.end(), word) != known.end();
  });
}

// The unit that the words end in, taken off.
std::string take_unit(Words& words) {
  static const std::vector<std::pair<Words, std::string>> units = {{{"rad", "s"}, "rad/s"},
                                                                   {{"radps"}, "rad/s"},
                                                                   {{"rads"}, "rad/s"},
                                                                   {{"rad", "sec"}, "rad/s"},
                                                                   {{"deg", "s"}, "deg/s"},
                                                                   {{"degps"}, "deg/s"},
                                                                   {{"turn", "s"}, "turn/s"},
                                                                   {{"turns", "s"}, "turn/s"},
                                                                   {{"rev", "s"}, "turn/s"},
                                                                   {{"rps"}, "turn/s"},
                                                                   {{"rpm"}, "rpm"},
                                                                   {{"1", "min"}, "rpm"},
                                                                   {{"u", "min"}, "rpm"},
                                                                   {{"grad"}, "deg"},
                                                                   {{"m", "s"}, "m/s"},
                                                                   {{"rad"}, "rad"},
                                                                   {{"deg"}, "deg"},
                                                                   {{"degrees"}, "deg"},
                                                                   {{"turn"}, "turn"},
                                                                   {{"turns"}, "turn"},
                                                                   {{"rev"}, "turn"},
                                                                   {{"m"}, "m"},
                                                                   {{"cm"}, "cm"},
                                                                   {{"mm"}, "mm"},
                                                                   {{"s"}, "s"},
                                                                   {{"sec"}, "s"},
                                                                   {{"secs"}, "s"},
                                                                   {{"seconds"}, "s"},
                                                                   {{"ms"}, "ms"},
                                                                   {{"msec"}, "ms"},
                                                                   {{"millis"}, "ms"},
                                                                   {{"us"}, "us"},
                                                                   {{"usec"}, "us"},
                                                                   {{"micros"}, "us"},
                                                                   {{"nanosec"}, "ns"},
                                                                   {{"ns"}, "ns"},
                                                                   {{"nsec"}, "ns"},
                                                                   {{"count"}, "count"},
                                                                   {{"counts"}, "count"},
                                                                   {{"tick"}, "count"},
                                                                   {{"ticks"}, "count"}};
  for (const auto& [end, unit] : units) {
    if (words.size() < end.size() || !std::equal(end.rbegin(), end.rend(), words.rbegin())) continue;
    words.resize(words.size() - end.size());
    return unit;
  }
  return "";
}

// A degree sign in UTF-8 or Latin-1 is a unit, too.
std::string degree_sign(std::string_view name) {
  const std::size_t at = name.find('\xb0');
  if (at == std::string_view::npos) return "";
  return name.substr(at + 1).starts_with("/s") ? "deg/s" : "deg";
}

std::string number_of(const Words& words) {
  for (const std::string& word : words)
    if (word.size() == 1 && word[0] >= '1' && word[0] <= '9') return word;
  return "";
}

// "left" of l, left, links; in sets the class' own names are left, right and numbers.
std::string which_of(const Words& words) {
  if (has(words, {"left", "l", "links", "lft"})) return "left";
  if (has(words, {"right", "r", "rechts", "rgt"})) return "right";
  return number_of(words);
}

// "FL" of front_left_wheel and of fl.
std::string quadrant_of(const Words& words) {
  static const std::map<std::string, std::string> kShort = {{"fl", "FL"}, {"lf", "FL"}, {"fr", "FR"},
                                                            {"rf", "FR"}, {"rl", "RL"}, {"bl", "RL"},
                                                            {"lr", "RL"}, {"rr", "RR"}, {"br", "RR"}};
  for (const std::string& word : words)
    if (const auto found = kShort.find(word); found != kShort.end()) return found->second;
  const bool front = has(words, {"front", "vorne", "vorn"}), rear = has(words, {"rear", "back", "hinten"});
  const std::string side = which_of(words);
  if (front == rear || (side != "left" && side != "right")) return "";
  return std::string(front ? "F" : "R") + (side == "left" ? "L" : "R");
}

Meaning meaning_of(const Words& words) {
  const std::string last = words.empty() ? "" : words.back();
  if (has(words, {"time", "stamp", "timestamp", "t", "zeit", "ts", "zeit", "temps", "tiempo"}))
    return Meaning::Time;
  if (has(words, {"steer", "steering"})) return Meaning::Steering;
  if (has(words, {"theta", "yaw", "heading", "psi", "gier", "gierwinkel"})) return Meaning::Heading;
  if (last == "x" || last == "px") return Meaning::X;
  if (last == "y" || last == "py") return Meaning::Y;
  const bool wheel = has(words, {"wheel", "w", "enc", "encoder", "traction", "drive", "motor", "omega"});
  if (wheel || !which_of(words).empty() || !quadrant_of(words).empty()) return Meaning::Wheel;
  return Meaning::Unknown;
}

}  // namespace

ColumnName column_name(std::string_view name) {
  ColumnName column;
  column.name = name;
  Words words = words_of(name);
  column.unit = degree_sign(name);
  if (column.unit.empty()) column.unit = take_unit(words);
  if (words.empty() &&
      (column.unit == "s" || column.unit == "ms" || column.unit == "us" || column.unit == "ns"))
    column.meaning = Meaning::Time;
  else
    column.meaning = meaning_of(words);
  column.odometry = has(words, {"odom", "odo", "odometry", "est", "ekf"});
  if (column.meaning == Meaning::Wheel || column.meaning == Meaning::Steering) {
    column.which = which_of(words);
    column.quadrant = quadrant_of(words);
    if (column.unit.empty() && has(words, {"enc", "encoder"})) column.unit = "count";
    if (column.unit == "m/s") column.unit.clear();  // of the rim: no unit of the map
  }
  return column;
}

std::string class_of_wheels(std::vector<std::string> driven, const std::vector<std::string>& steered) {
  std::sort(driven.begin(), driven.end());
  const bool pair = driven == std::vector<std::string>{"left", "right"};
  if (pair && steered.empty()) return "differential";
  if (pair && steered == std::vector<std::string>{""}) return "bicycle";
  if (pair && steered.size() == 2) return "ackermann";
  if (driven == std::vector<std::string>{""} && steered == driven) return "tricycle";
  return driven == std::vector<std::string>{"1", "2", "3"} && steered.empty() ? "omni3" : "";
}

}  // namespace odobench
