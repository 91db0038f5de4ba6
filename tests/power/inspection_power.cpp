// How small a fault may be and still be named: injects each fault in each of its sizes into made-up sets and
// prints the share of them in which it is named, and how often another warning or error came with it.
//
// usage: inspection_power [SETS]
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <string>

#include "problems/inspection/inspect.hpp"
#include "tests/support/faulty_sets.hpp"

int main(int argc, char** argv) {
  using namespace odobench;
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
