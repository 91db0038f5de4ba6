// How small a fault may be and still be named: injects each fault in each of its sizes into made-up sets and
// prints the share of them in which it is named, and how often another warning or error came with it.
//
// usage: inspection_power [SETS]            faults in the thesis' robot
//        inspection_power --clean [SETS]    sets without faults, SETS of every class: what is said of them
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <string>

#include "datasets/robots/layouts.hpp"
#include "problems/inspection/inspect.hpp"
#include "tests/support/faulty_sets.hpp"

namespace odobench {
namespace {

void look_at_clean_sets(int sets) {
  int all = 0, alarms = 0;
  for (const robots::Layout& layout : robots::layouts())
    for (int s = 1; s <= sets; ++s) {
      const Dataset d = testing::clean_set(layout.name, static_cast<std::uint64_t>(s));
      bool alarm = false;
      for (const inspection::Finding& f : inspection::inspect(d.robot, d.recordings)) {
        if (f.severity == inspection::Severity::Note) continue;
        alarm = true;
        fmt::print("{}, seed {}: {}: {}\n", layout.name, s, f.kind, f.message);
      }
      ++all;
      alarms += alarm ? 1 : 0;
    }
  fmt::print("{} clean sets, {} with warnings or errors\n", all, alarms);
}

}  // namespace
}  // namespace odobench

int main(int argc, char** argv) {
  using namespace odobench;
  if (argc > 1 && std::string(argv[1]) == "--clean") {
    look_at_clean_sets(argc > 2 ? std::atoi(argv[2]) : 16);
    return 0;
  }
  const int sets = argc > 1 ? std::atoi(argv[1]) : 20;
  std::vector<Dataset> clean;
  int alarms = 0;
  for (int s = 0; s < sets; ++s) {
    clean.push_back(testing::clean_set("4wis4wid", static_cast<std::uint64_t>(s + 1)));
    if (!inspection::inspect(clean.back().robot, clean.back().recordings).empty()) ++alarms;
  }
  fmt::print(
      "{} clean sets, {} with findings\n| fault | kind | size | named | with others "
      "|\n|---|---|---|---|---|\n",
      sets, alarms);
  for (const testing::Fault& fault : testing::faults())
    for (const double size : fault.sizes) {
      int named = 0, others = 0;
      std::set<std::string> which;
      for (Dataset d : clean) {
        fault.inject(d, size);
        const auto found = inspection::inspect(d.robot, d.recordings);
        const auto is_it = [&](const inspection::Finding& f) { return f.kind == fault.kind; };
        if (std::any_of(found.begin(), found.end(), is_it)) ++named;
        if (!std::all_of(found.begin(), found.end(), is_it)) ++others;
        for (const inspection::Finding& f : found)
          if (!is_it(f)) which.insert(f.kind);
      }
      fmt::print("| {} | {} | {:.4g} {} | {:.2f} | {:.2f} {} |\n", fault.name, fault.kind, size, fault.unit,
                 static_cast<double>(named) / sets, static_cast<double>(others) / sets,
                 fmt::join(which, " "));
    }
  return 0;
}
