// Figures of a record that say themselves what they are: no reader takes a name apart.
#pragma once

#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/better.hpp"

namespace odobench {

class JsonNode;

struct Measure {
  std::string name;  // the only one of its record: "sensor.gyro.nis"
  double value = 0;
  std::string unit;  // "" of counts, shares, ratios, and where the thesis gives none
  Better better = Better::None;
  // Where a record measures several things alike, which of them: a sensor, a drive, a parameter, a channel.
  std::string of = {};
  bool timing = false;  // depends on the machine and its load
};

// The measures of one record, by name and in its order.
class Measures {
 public:
  Measures() = default;
  Measures(std::initializer_list<Measure> list);

  // Takes the place of one with the same name.
  void put(Measure measure);
  // Null when there is none.
  const Measure* find(std::string_view name) const;
  std::optional<double> value(std::string_view name) const;
  // What the measures are of, each once and in alphabetical order; measures of nothing in particular give
  // none.
  std::vector<std::string> subjects() const;

  bool empty() const { return list_.empty(); }
  std::size_t size() const { return list_.size(); }
  auto begin() const { return list_.begin(); }
  auto end() const { return list_.end(); }

 private:
  struct ByName {
    using is_transparent = void;
    bool operator()(const Measure& a, const Measure& b) const { return a.name < b.name; }
    bool operator()(const Measure& a, std::string_view b) const { return a.name < b; }
    bool operator()(std::string_view a, const Measure& b) const { return a < b.name; }
  };
  std::set<Measure, ByName> list_;
};

// [{"name", "value", "unit", "better", "of", "timing"}, ..]: better is "lower", "higher" or "none"; "of" and
// "timing" are written where they say something. A value that is not finite is null.
nlohmann::json to_json(const Measures& measures);
// DataError names the place; a name that stands twice is refused. Fields that it does not know are ignored.
Measures measures_from(const JsonNode& list);

}  // namespace odobench
