// Solver options as a user writes them, `pso[swarm=60,inertia=0.7]`, bound to the fields of an options
// struct.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace odobench {

using OptionValues = std::map<std::string, std::string>;

// "pso[swarm=60]" taken apart.
struct SolverSpec {
  std::string name;          // "pso", "nlopt:bobyqa"
  OptionValues options;      // {{"swarm","60"}}
  std::string text() const;  // canonical: options in alphabetical order; the label of tables
};

// Splits "lm,pso[swarm=60,inertia=0.7]" at the commas outside brackets; a value may have brackets of its own,
// multistart[solver=lm[patience=100]]. Throws std::invalid_argument on unbalanced
// brackets, empty names, an option without '=' or given twice.
std::vector<SolverSpec> parse_solver_list(std::string_view text);

struct OptionDescription {
  std::string name;
  std::string value;    // in force (the default, before apply)
  std::string allowed;  // "1..1000", "thesis|matlab|modern", "true|false"
  std::string help;
};

// Ties option names to fields; one list serves parsing, validation, `bench list solvers` and the run record.
//
// What takes memory or time before the first evaluation has an upper limit, so that a typing error is told
// and does not run out of memory.
inline constexpr int kLargestPopulation = 100'000;

class OptionBinder {
 public:
  void number(std::string name, double& field, std::string help,
              double lowest = -std::numeric_limits<double>::infinity(),
              double highest = std::numeric_limits<double>::infinity());
  void integer(std::string name, int& field, std::string help, int lowest = std::numeric_limits<int>::min(),
               int highest = std::numeric_limits<int>::max());
  // Numbers that the method chooses itself unless one is given: "auto", which the field holds as -1 (double)
  // or 0 (int) and which no number typed means.
  void automatic(std::string name, double& field, std::string help, double lowest, double highest);
  void automatic(std::string name, int& field, std::string help, int lowest, int highest);
  void flag(std::string name, bool& field, std::string help);
  void choice(std::string name, std::string& field, std::string help, std::vector<std::string> allowed);

  // Any text but none; `allowed` says what is meant.
  void text(std::string name, std::string& field, std::string help, std::string allowed);

  // Writes the values into the fields. Throws std::invalid_argument: unknown key (lists the known ones and
  // the nearest), not a number, outside the range; the message names solver, field, value and the violated
  // relation.
  void apply(const std::string& solver, const OptionValues& values);
  std::vector<OptionDescription> describe() const;
  // Every option with the value in force.
  OptionValues values() const;

 private:
  struct Entry {
    std::string name, help, allowed;
    std::function<std::string()> get;
    std::function<std::string(const std::string&)> set;  // "" or what is wrong
  };
  std::vector<Entry> entries_;
};

}  // namespace odobench
