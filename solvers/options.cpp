#include "solvers/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "base/names.hpp"

namespace odobench {
namespace {

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

template <class T>
bool parse_all(const std::string& text, T& out) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, out);
  return error == std::errc() && stop == end;
}

template <class T>
std::string range_text(T low, T high) {
  const bool open_low = low == std::numeric_limits<T>::lowest() ||
                        (std::is_floating_point_v<T> && std::isinf(static_cast<double>(low)));
  const bool open_high = high == std::numeric_limits<T>::max() ||
                         (std::is_floating_point_v<T> && std::isinf(static_cast<double>(high)));
  if (open_low && open_high) return "any";
  if (open_high) return fmt::format(">= {}", low);
  if (open_low) return fmt::format("<= {}", high);
  return fmt::format("{}..{}", low, high);
}

// Brackets may hold brackets: multistart[solver=lm[patience=100],starts=20].
std::vector<std::string> split_outside_brackets(std::string_view text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (char c : text) {
    if (c == '[') ++depth;
    if (c == ']') --depth;
    if (depth < 0)
      throw std::invalid_argument(
          fmt::format("solver list '{}': unbalanced brackets; expected name[option=value,...]", text));
    if (c == ',' && depth == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  if (depth != 0)
    throw std::invalid_argument(
        fmt::format("solver list '{}': unbalanced brackets; expected name[option=value,...]", text));
  return parts;
}

// Where the bracket that is opened at `open` is closed.
std::size_t closing_bracket(std::string_view text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == '[') ++depth;
    if (text[i] == ']' && --depth == 0) return i;
  }
  return std::string_view::npos;
}

SolverSpec parse_spec(const std::string& part, std::string_view whole) {
  SolverSpec spec;
  const auto open = part.find('[');
  spec.name = trimmed(std::string_view(part).substr(0, open));
  if (spec.name.empty())
    throw std::invalid_argument(
        fmt::format("solver list '{}': an empty solver name; expected e.g. lm,pso[swarm=60]", whole));
  if (open == std::string::npos) return spec;
  if (closing_bracket(part, open) != trimmed(part).size() + part.find_first_not_of(" \t") - 1)
    throw std::invalid_argument(fmt::format("solver list '{}': text after ']' in '{}'", whole, part));
  const std::string inside = part.substr(open + 1, part.rfind(']') - open - 1);
  if (trimmed(inside).empty()) return spec;
  for (const std::string& item : split_outside_brackets(inside)) {
    const auto equals = item.find('=');
    if (equals == std::string::npos || trimmed(item.substr(0, equals)).empty() || item.find('[') < equals)
      throw std::invalid_argument(
          fmt::format("solver '{}': option '{}'; expected name=value", spec.name, trimmed(item)));
    const std::string key = trimmed(item.substr(0, equals));
    if (!spec.options.emplace(key, trimmed(item.substr(equals + 1))).second)
      throw std::invalid_argument(fmt::format("solver '{}': option '{}' is given twice", spec.name, key));
  }
  return spec;
}

}  // namespace

std::string SolverSpec::text() const {
  if (options.empty()) return name;
  std::string inside;
  for (const auto& [key, value] : options) inside += (inside.empty() ? "" : ",") + key + "=" + value;
  return name + "[" + inside + "]";
}

std::vector<SolverSpec> parse_solver_list(std::string_view text) {
  std::vector<SolverSpec> specs;
  for (const std::string& part : split_outside_brackets(text)) specs.push_back(parse_spec(part, text));
  return specs;
}

void OptionBinder::number(std::string name, double& field, std::string help, double lowest, double highest) {
  const std::string allowed = range_text(lowest, highest);
  entries_.push_back({std::move(name), std::move(help), allowed,
                      [&field] { return fmt::format("{}", field); },
                      [&field, lowest, highest, allowed](const std::string& text) -> std::string {
                        double value = 0;
                        if (!parse_all(text, value) || std::isnan(value))
                          return "expected a number, " + allowed;
                        if (value < lowest || value > highest) return "expected " + allowed;
                        field = value;
                        return {};
                      }});
}

void OptionBinder::integer(std::string name, int& field, std::string help, int lowest, int highest) {
  const std::string allowed = range_text(lowest, highest);
  entries_.push_back({std::move(name), std::move(help), allowed,
                      [&field] { return fmt::format("{}", field); },
                      [&field, lowest, highest, allowed](const std::string& text) -> std::string {
                        int value = 0;
                        if (!parse_all(text, value)) return "expected a whole number, " + allowed;
                        if (value < lowest || value > highest) return "expected " + allowed;
                        field = value;
                        return {};
                      }});
}

namespace {

constexpr const char* kAuto = "auto";

template <class T>
std::string automatic_text(T field, T automatic) {
  return field == automatic ? kAuto : fmt::format("{}", field);
}

template <class T>
std::string set_automatic(const std::string& text, T automatic, T lowest, T highest,
                          const std::string& allowed, T& field) {
  T value = 0;
  const bool is_auto = text == kAuto;
  if (!is_auto && (!parse_all(text, value) || !(value >= lowest && value <= highest)))
    return "expected " + allowed;
  field = is_auto ? automatic : value;
  return {};
}

}  // namespace

void OptionBinder::automatic(std::string name, double& field, std::string help, double lowest,
                             double highest) {
  const std::string allowed = fmt::format("{} or {}", kAuto, range_text(lowest, highest));
  entries_.push_back({std::move(name), std::move(help), allowed,
                      [&field] { return automatic_text(field, -1.0); },
                      [&field, lowest, highest, allowed](const std::string& text) {
                        return set_automatic(text, -1.0, lowest, highest, allowed, field);
                      }});
}

void OptionBinder::automatic(std::string name, int& field, std::string help, int lowest, int highest) {
  const std::string allowed = fmt::format("{} or {}", kAuto, range_text(lowest, highest));
  entries_.push_back({std::move(name), std::move(help), allowed,
                      [&field] { return automatic_text(field, 0); },
                      [&field, lowest, highest, allowed](const std::string& text) {
                        return set_automatic(text, 0, lowest, highest, allowed, field);
                      }});
}

void OptionBinder::flag(std::string name, bool& field, std::string help) {
  entries_.push_back({std::move(name), std::move(help), "true|false",
                      [&field] { return field ? "true" : "false"; },
                      [&field](const std::string& text) -> std::string {
                        if (text != "true" && text != "false") return "expected true or false";
                        field = text == "true";
                        return {};
                      }});
}

void OptionBinder::choice(std::string name, std::string& field, std::string help,
                          std::vector<std::string> allowed) {
  const std::string list = fmt::format("{}", fmt::join(allowed, "|"));
  entries_.push_back({std::move(name), std::move(help), list, [&field] { return field; },
                      [&field, allowed = std::move(allowed), list](const std::string& text) -> std::string {
                        if (std::find(allowed.begin(), allowed.end(), text) == allowed.end())
                          return "expected " + list;
                        field = text;
                        return {};
                      }});
}

void OptionBinder::text(std::string name, std::string& field, std::string help, std::string allowed) {
  entries_.push_back({std::move(name), std::move(help), std::move(allowed), [&field] { return field; },
                      [&field](const std::string& text) -> std::string {
                        if (text.empty()) return "expected a value";
                        field = text;
                        return {};
                      }});
}

void OptionBinder::apply(const std::string& solver, const OptionValues& values) {
  for (const auto& [key, text] : values) {
    const auto entry =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.name == key; });
    if (entry == entries_.end()) {
      std::vector<std::string> names;
      for (const Entry& e : entries_) names.push_back(e.name);
      throw std::invalid_argument(
          fmt::format("solver '{}': unknown option '{}'{}; known: {}", solver, key, did_you_mean(key, names),
                      names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
    }
    const std::string wrong = entry->set(text);
    if (!wrong.empty())
      throw std::invalid_argument(fmt::format("solver '{}': option {}={}; {}", solver, key, text, wrong));
  }
}

std::vector<OptionDescription> OptionBinder::describe() const {
  std::vector<OptionDescription> list;
  for (const Entry& e : entries_) list.push_back({e.name, e.get(), e.allowed, e.help});
  return list;
}

OptionValues OptionBinder::values() const {
  OptionValues values;
  for (const Entry& e : entries_) values[e.name] = e.get();
  return values;
}

}  // namespace odobench
