// Pieces of Vega-Lite specifications that figures share (https://vega.github.io/vega-lite/docs/).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace odobench::vega {

using nlohmann::json;

// How legends call what results are compared with, and the row of parameters that nobody fitted.
inline constexpr const char* kReferenceLabel = "motion capture";
inline constexpr const char* kNominalLabel = "nominal";

// {"name", "format": {"type": "csv", "parse": ..}}: columns listed in `numbers` are numbers, the others text.
json csv_data(const std::string& name, const std::vector<std::string>& numbers);

// Encoding channels. An empty title leaves the axis or legend without one. Quantitative scales need not
// contain 0.
json quantitative(const std::string& field, const std::string& title);
json logarithmic(const std::string& field, const std::string& title);
// In the order given, not sorted.
json nominal(const std::string& field, const std::string& title, const std::vector<std::string>& domain);

// Colours of lines, named in the legend by a piece of line.
json line_color(const std::string& field, const std::vector<std::string>& domain);

// A transform that turns the number in `index` into one of the names.
json name_of(const std::string& index, const std::vector<std::string>& names, const std::string& as);
json filter(const std::string& expression);

// A choice offered to readers: the top-level parameter, and its entry of usermeta.odobench.controls.
struct Choice {
  std::string parameter, label;
  std::vector<std::pair<std::string, std::string>> options;  // value, label
  std::string chosen;                                        // a value
};
// "$schema", description, `data`, the parameters and usermeta of the choices; `body` adds the rest.
json specification(const std::string& description, json data, const std::vector<Choice>& choices, json body);

// "all" first, then one per name.
Choice choice_of(const std::string& parameter, const std::string& label, const std::string& all,
                 const std::vector<std::string>& names);

// Letters, digits, '_' and '-' stay, everything else becomes '-': for ids.
std::string slug(const std::string& text);

}  // namespace odobench::vega
