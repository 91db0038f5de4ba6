// Parameter sets that users name: by what a data set knows, or in files of their own.
#pragma once

#include <string>
#include <vector>

#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/watcher.hpp"

namespace odobench {

struct ParameterSet {
  std::string label;
  Vector values;  // in the problem's order, its units
};

// What entries of --parameters are about, and the sets that they may call by name.
struct ParameterNames {
  std::vector<ParameterInfo> parameters;
  std::vector<NamedParameters> known;
  std::string robot = {};  // class, for what is said of names that are not its own; "": nothing
};
ParameterNames parameter_names(const LoadedProblem& loaded);

// One entry of --parameters: "nominal", a known name ("published:lm", "truth"), or a JSON file holding {"a1":
// 0.1125, ..., "r4": 0.0254} in the problem's units or an array of such objects; "name" is optional and
// becomes the label, else the file's stem with a number behind it in an array. Or a file that a run keeps of
// its results (bench/studies/parameter_files.hpp). Throws std::invalid_argument on a name that is neither
// (lists the known ones), DataError naming file and key on a file that is not as described: missing, unknown
// or doubled keys, values that are no finite numbers.
std::vector<ParameterSet> read_parameters(const ParameterNames& names, const std::string& source,
                                          const char* option = "--parameters");

// Warns where the set's parameters lie outside the box.
void warn_outside(const LoadedProblem& loaded, const ParameterSet& set, Watcher& watcher);

// Throws std::invalid_argument when there is one of this label already.
void add_parameter_set(ParameterSet set, std::vector<ParameterSet>& sets);

// The entries of comma lists of such, except where a file has a comma in its name; "nominal" for none.
std::vector<std::string> split_sources(const std::vector<std::string>& lists);

}  // namespace odobench
