#include "bench/catalogue/problem_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "base/names.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"

namespace odobench {
namespace {

constexpr int kMostInstance = 1000000, kMostDimension = 1000;

// Where the bracket that holds options begins, npos without one.
std::size_t options_at(const std::string& text) {
  const std::size_t open = text.rfind('[');
  return open != std::string::npos && text.back() == ']' && text.find('=', open) != std::string::npos
             ? open
             : std::string::npos;
}

// The position behind the bracket that opens at `open` if it holds options, else behind the '['.
std::size_t behind_bracket(const std::string& list, std::size_t open) {
  const std::size_t close = list.find(']', open), sign = list.find('=', open);
  return close != std::string::npos && sign < close ? close + 1 : open + 1;
}

int number(const std::string& whole, const std::string& key, const std::string& value, int most) {
  return static_cast<int>(whole_number(fmt::format("--problem: '{}': {}", whole, key), value, 1, most));
}

void read_option(const std::string& whole, const std::string& item, ProblemName& name) {
  const std::size_t sign = item.find('=');
  if (sign == std::string::npos)
    throw std::invalid_argument(
        fmt::format("--problem: '{}': found '{}', expected option=value", whole, item));
  const std::string key = item.substr(0, sign), value = item.substr(sign + 1);
  if ((key == "n" && name.dimension) || (key == "instance" && name.instance))
    throw std::invalid_argument(fmt::format("--problem: '{}': {} is given twice", whole, key));
  if (key == "n") {
    name.dimension = number(whole, key, value, kMostDimension);
  } else if (key == "instance") {
    const std::size_t dots = value.find("..");
    name.instance = number(whole, key, value.substr(0, dots), kMostInstance);
    name.last_instance =
        dots == std::string::npos ? name.instance : number(whole, key, value.substr(dots + 2), kMostInstance);
    if (*name.last_instance < *name.instance)
      throw std::invalid_argument(
          fmt::format("--problem: '{}': instance={}: expected the lower number first", whole, value));
  } else {
    throw std::invalid_argument(fmt::format("--problem: '{}': unknown option '{}'{}, expected n or instance",
                                            whole, key, did_you_mean(key, {"n", "instance"})));
  }
}

}  // namespace

std::string ProblemName::options() const {
  std::vector<std::string> list;
  if (dimension) list.push_back(fmt::format("n={}", *dimension));
  if (instance) list.push_back(fmt::format("instance={}", *instance));
  return list.empty() ? "" : fmt::format("[{}]", fmt::join(list, ","));
}

std::vector<std::string> problem_items(const std::vector<std::string>& lists) {
  std::vector<std::string> items;
  for (const std::string& list : lists) {
    std::string item;
    for (std::size_t at = 0; at < list.size();) {
      if (list[at] == ',') {
        items.push_back(std::move(item));
        item.clear();
        ++at;
        continue;
      }
      const std::size_t next = list[at] == '[' ? behind_bracket(list, at) : at + 1;
      item += list.substr(at, next - at);
      at = next;
    }
    items.push_back(std::move(item));
  }
  return items;
}

ProblemName parse_problem_name(const std::string& text) {
  ProblemName name;
  const std::size_t open = options_at(text);
  name.base = text.substr(0, open);
  if (open == std::string::npos) return name;
  for (const std::string& item : comma_items(text.substr(open + 1, text.size() - open - 2)))
    read_option(text, item, name);
  return name;
}

std::string problem_variant(const ClassicEntry& about, int dimension, int instance) {
  ProblemName name;
  if (dimension != 0 && dimension != about.dimension) name.dimension = dimension;
  if (instance > 1) name.instance = instance;
  return name.options();
}

}  // namespace odobench
