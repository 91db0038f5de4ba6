#include "bench/verbs/suite_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "problems/suites/hardness.hpp"

namespace odobench {
namespace {

struct Suite {
  const char* family;
  const char* title;
  const char* start;
  const char* optimum;
  const char* hard;
};

constexpr std::array<Suite, 6> kSuites{{
    {"classic", "Test functions", "one point", "0, or proven", "each one thing: see its line"},
    {"nist", "NIST StRD nonlinear regression", "two official ones", "certified to 11 digits",
     "scales, dependent parameters; /1 begins far away"},
    {"mgh", "More, Garbow, Hillstrom (1981)", "the paper's, 10 and 100 times it", "lowest known",
     "valleys, singular Jacobians, plateaus; /10 and /100 begin far away"},
    {"bbob", "BBOB noiseless (2009)", "the middle of the box", "exact, shifted and rotated by instance",
     "conditions, ridges, many minima, deceptive funnels"},
    {"mw", "More, Wild (2009), smooth", "the paper's, /10 ten times it", "lowest known",
     "made for methods without derivatives: small, unlike scales"},
    {"robots", "Calibrations of simulated robots", "nominal parameters", "lowest known, truth by seed",
     "noise, parameters that data barely tell apart"},
}};

std::string numbers(const Vector& x) {
  if (x.size() > 1 && (x.array() == x[0]).all()) return fmt::format("all {:g}", x[0]);
  constexpr Eigen::Index kShown = 4;
  std::string text;
  for (Eigen::Index i = 0; i < std::min(kShown, x.size()); ++i)
    text += fmt::format("{}{:.4g}", i == 0 ? "" : ", ", x[i]);
  return x.size() > kShown ? text + ", ..." : text;
}

std::string optimum_text(const Problem& problem) {
  if (!problem.known_optimum()) return "unknown";
  const std::size_t points = problem.known_minimisers().size();
  return fmt::format("{:.10g}{}", *problem.known_optimum(),
                     points == 0 ? "" : fmt::format(" at {} known point{}", points, points == 1 ? "" : "s"));
}

std::vector<Cell> problem_cells(const ProblemEntry& entry, const Suite& suite) {
  const std::string hard = what_is_hard(entry.about);
  if (entry.about.family == "robots")
    return {text_cell(entry.about.name), count_cell(entry.about.dimension), text_cell("nominal parameters"),
            text_cell(suite.optimum), text_cell(hard)};
  const Problem problem = entry.make({}).problem;
  return {text_cell(entry.about.name), count_cell(entry.about.dimension), text_cell(numbers(problem.start())),
          text_cell(optimum_text(problem)), text_cell(hard)};
}

}  // namespace

std::vector<Table> suite_tables(const Catalogue& catalogue) {
  std::vector<Table> tables{
      {"suites",
       "Suites of problems",
       {text_column("suite"), text_column("title"), number_column("problems"), number_column("instances"),
        text_column("start"), text_column("optimum"), text_column("hard", "what makes it hard")},
       {},
       {"All problems of one: --problem='bbob:*'; with options: 'bbob:*[n=5,instance=1..15]'."}}};
  for (const Suite& suite : kSuites) {
    Table table{fmt::format("suites.{}", suite.family),
                suite.title,
                {text_column("problem"), number_column("dimension"), text_column("start"),
                 text_column("optimum", "lowest known J"), text_column("hard", "what makes it hard")},
                {},
                {}};
    int instances = 1;
    for (const ProblemEntry& entry : catalogue.problems()) {
      if (entry.about.family != suite.family) continue;
      instances = std::max(instances, entry.about.instances);
      table.rows.push_back(problem_cells(entry, suite));
    }
    tables.front().rows.push_back({text_cell(suite.family), text_cell(suite.title),
                                   count_cell(static_cast<double>(table.rows.size())), count_cell(instances),
                                   text_cell(suite.start), text_cell(suite.optimum), text_cell(suite.hard)});
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace odobench
