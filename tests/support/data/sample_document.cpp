#include "tests/support/data/sample_document.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <random>

namespace odobench::testing {
namespace {

using nlohmann::json;

const std::vector<std::string> kMethods{"nominal", "lm", "ip", "ga", "pso", "cmaes"};
const std::vector<std::string> kTrajectories{"line_x", "line_y", "circle", "square", "eight"};

double noise(std::mt19937_64& random) {
  return (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5) * 2;
}

Column column(std::string id, std::string name, std::string unit = "", std::string group = "") {
  Column made;
  made.id = std::move(id);
  made.name = std::move(name);
  made.unit = std::move(unit);
  made.group = std::move(group);
  return made;
}

Column text_column(const std::string& id) {
  Column made = column(id, id);
  made.align = Align::Left;
  return made;
}

Table table_of(std::string id, std::string title, std::vector<Column> columns) {
  return {std::move(id), std::move(title), std::move(columns), {}, {}};
}

// Five repetitions of a drive and what each method makes of it.
std::string tracks_csv(std::mt19937_64& random) {
  std::string out = "method,repetition,t,x,y\n";
  for (std::size_t m = 0; m < kMethods.size(); ++m)
    for (int repetition = 1; repetition <= 5; ++repetition) {
      const double error = (m == 0 ? 0.12 : 0.01) * noise(random);
      for (int k = 0; k <= 400; ++k) {
        const double t = 0.05 * k, angle = 2 * 3.14159265358979 * k / 400;
        out += fmt::format("{},{},{:.2f},{:.5f},{:.5f}\n", kMethods[m], repetition, t,
                           1.5 * std::sin(angle) + error * t / 4,
                           1.5 * (1 - std::cos(angle)) + 0.4 * error * t + 0.002 * noise(random));
      }
    }
  return out;
}

std::string errors_csv(std::mt19937_64& random) {
  std::string out = "trajectory,method,variable,error\n";
  for (const std::string& trajectory : kTrajectories)
    for (std::size_t m = 0; m < kMethods.size(); ++m)
      for (const char* variable : {"x", "y", "theta"})
        for (int n = 0; n < 10; ++n)
          out += fmt::format("{},{},{},{:.6f}\n", trajectory, kMethods[m], variable,
                             (m == 0 ? 0.12 : 0.03) * (1 + 0.6 * noise(random)));
  return out;
}

std::string traces_csv(std::mt19937_64& random) {
  std::string out = "method,evaluations,cost,low,high\n";
  for (std::size_t m = 1; m < kMethods.size(); ++m)
    for (int k = 0; k <= 60; ++k) {
      const double evaluations = std::pow(10, k / 12.0);
      const double cost =
          98.1 + 1040 * std::exp(-k / (4.0 + 3.0 * static_cast<double>(m))) * (1 + 0.05 * noise(random));
      out += fmt::format("{},{:.1f},{:.4f},{:.4f},{:.4f}\n", kMethods[m], evaluations, cost,
                         98 + 0.9 * (cost - 98), 98 + 1.2 * (cost - 98));
    }
  return out;
}

std::string correlations_csv() {
  std::string out = "first,second,value\n";
  const std::vector<std::string> names{"a1", "a2", "a3", "a4", "b1", "b2",
                                       "b3", "b4", "r1", "r2", "r3", "r4"};
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = 0; j < names.size(); ++j)
      out += fmt::format("{},{},{:.3f}\n", names[i], names[j],
                         i == j ? 1.0 : std::sin(1.7 * static_cast<double>(i * j + i + j)) * 0.9);
  return out;
}

json csv(const std::string& name, json numbers) {
  return {{"name", name}, {"format", {{"type", "csv"}, {"parse", std::move(numbers)}}}};
}

json method_control(const std::string& value, bool nominal) {
  json options = json::array();
  for (const std::string& method : kMethods)
    if (nominal || method != "nominal") options.push_back({{"value", method}, {"label", method}});
  return {
      {"params", {{{"name", "method"}, {"value", value}}}},
      {"usermeta",
       {{"odobench", {{"controls", {{{"param", "method"}, {"label", "Method"}, {"options", options}}}}}}}}};
}

json quantitative(const std::string& field, const std::string& title) {
  return {{"field", field}, {"type", "quantitative"}, {"title", title}};
}

json nominal(const std::string& field, const json& title) {
  return {{"field", field}, {"type", "nominal"}, {"title", title}};
}

Figure path_figure() {
  json spec = method_control("lm", true);
  spec.update({{"data", csv("tracks", {{"x", "number"}, {"y", "number"}, {"t", "number"}})},
               {"width", kFigureWidth},
               {"height", 420},
               {"transform", {{{"filter", "datum.method === method"}}}},
               {"mark", "line"}});
  spec["encoding"] = {{"x", quantitative("x", "x [m]")},
                      {"y", quantitative("y", "y [m]")},
                      {"order", {{"field", "t"}, {"type", "quantitative"}}},
                      {"color", nominal("repetition", "Repetition")}};
  return {"path.circle", "Paths of the five repetitions on the circle",
          "Estimated positions in metres, one line per repetition; the method can be chosen above.", spec};
}

Figure deviations_figure() {
  json spec = method_control("nominal", true);
  spec["usermeta"]["odobench"]["columns"] = 2;
  spec["data"] = csv("tracks", {{"x", "number"}, {"y", "number"}, {"t", "number"}});
  spec["transform"] = {{{"filter", "datum.method === method"}}};
  spec["columns"] = 2;
  for (const char* variable : {"x", "y"})
    spec["concat"].push_back({{"title", fmt::format("Position {}", variable)},
                              {"width", kFigureWidth / 2 - 40},
                              {"height", 220},
                              {"mark", "line"},
                              {"encoding",
                               {{"x", quantitative("t", "Time [s]")},
                                {"y", quantitative(variable, fmt::format("{} [m]", variable))},
                                {"color", nominal("repetition", "Repetition")}}}});
  return {"position.circle", "Positions over time", "Metres over seconds, side by side.", spec};
}

Figure boxes_figure() {
  json spec = {{"data", csv("errors", {{"error", "number"}})}, {"width", kFigureWidth}, {"height", 260}};
  spec["params"] = {{{"name", "variable"}, {"value", "x"}}};
  json options = json::array();
  for (const char* variable : {"x", "y", "theta"})
    options.push_back({{"value", variable}, {"label", variable}});
  spec["usermeta"] = {
      {"odobench", {{"controls", {{{"param", "variable"}, {"label", "Variable"}, {"options", options}}}}}}};
  spec["transform"] = {{{"filter", "datum.variable === variable"}}};
  spec["mark"] = {{"type", "boxplot"}, {"extent", 1.5}};
  spec["encoding"] = {{"x", nominal("trajectory", nullptr)},
                      {"xOffset", {{"field", "method"}}},
                      {"y", quantitative("error", "Largest error of a drive")},
                      {"color", nominal("method", "Method")}};
  return {"spread.errors", "Spread of the errors", "Boxes hold the middle half of ten drives.", spec};
}

Figure convergence_figure() {
  json spec = {
      {"data",
       csv("traces", {{"evaluations", "number"}, {"cost", "number"}, {"low", "number"}, {"high", "number"}})},
      {"width", kFigureWidth},
      {"height", 300}};
  json x = quantitative("evaluations", "Evaluations of the cost");
  x["scale"] = {{"type", "log"}};
  json y = quantitative("cost", "Best cost so far");
  y["scale"] = {{"type", "log"}};
  spec["encoding"] = {{"x", x}, {"color", nominal("method", "Method")}};
  spec["layer"] = {
      {{"mark", "area"},
       {"encoding", {{"y", quantitative("low", "Best cost so far")}, {"y2", {{"field", "high"}}}}}},
      {{"mark", "line"}, {"encoding", {{"y", y}}}}};
  spec["layer"][0]["encoding"]["y"]["scale"] = {{"type", "log"}};
  return {"convergence", "Convergence", "Median over ten seeds; the band holds the middle half.", spec};
}

Figure heat_figure() {
  json spec = {{"data", csv("correlations", {{"value", "number"}})},
               {"width", kFigureWidth},
               {"height", 360},
               {"mark", "rect"}};
  json colour = quantitative("value", "Correlation");
  colour["scale"] = {{"domain", {-1, 1}}, {"scheme", "blueorange"}};
  spec["encoding"] = {{"x", nominal("first", nullptr)}, {"y", nominal("second", nullptr)}, {"color", colour}};
  return {"correlation", "Correlation of the parameters", "From the inverse of J'J at the optimum.", spec};
}

Figure bars_figure() {
  json spec = {{"data", csv("errors", {{"error", "number"}})}, {"width", kFigureWidth}, {"height", 240}};
  spec["encoding"] = {{"y", nominal("method", nullptr)}};
  spec["layer"] = {
      {{"mark", {{"type", "errorbar"}, {"extent", "ci"}}},
       {"encoding", {{"x", quantitative("error", "Error [m]")}}}},
      {{"mark", "point"},
       {"encoding", {{"x", {{"field", "error"}, {"type", "quantitative"}, {"aggregate", "mean"}}}}}}};
  return {"means", "Mean errors with 95 % intervals", "Bootstrap intervals over all drives, in metres.",
          spec};
}

Figure histogram_figure() {
  json spec = {{"data", csv("errors", {{"error", "number"}})}, {"columns", 3}};
  spec["usermeta"] = {{"odobench", {{"columns", 3}}}};
  spec["facet"] = {{"field", "method"}, {"title", nullptr}};
  json x = quantitative("error", "Error [m]");
  x["bin"] = {{"maxbins", 20}};
  json y = {{"aggregate", "count"}, {"title", "Drives"}};
  spec["spec"] = {{"width", 170}, {"height", 120}, {"mark", "bar"}, {"encoding", {{"x", x}, {"y", y}}}};
  return {"histogram", "Distribution of the errors", "Number of drives by error, one view per method.", spec};
}

Table errors_table(std::mt19937_64& random) {
  Table table = table_of("errors.circle", "Errors on the circle", {text_column("method")});
  for (const std::string variable : {"x", "y", "theta"})
    for (const char* what : {"max", "sr", "sigma"})
      table.columns.push_back(column(fmt::format("e_{}_{}", what, variable),
                                     fmt::format("e_{},{}", variable, what),
                                     variable == "theta" ? "rad" : "m", variable));
  for (std::size_t m = 0; m < kMethods.size(); ++m) {
    std::vector<Cell> row{text_cell(kMethods[m])};
    for (int k = 0; k < 9; ++k) {
      row.push_back(fixed_cell((m == 0 ? 0.12 : 0.03) * (1 + 0.6 * noise(random)), 6));
      if (m > 0) row.back().difference = -0.05 * (1 + 0.5 * noise(random));
    }
    table.rows.push_back(row);
  }
  table.notes = {"In brackets: the difference to the nominal parameters.",
                 "e_max and e_sr are the largest and the mean error of five repetitions, sigma their "
                 "standard deviation."};
  return table;
}

Table solvers_table() {
  Table table =
      table_of("solvers", "Solvers",
               {text_column("solver"), column("cost", "J"), column("change", "change", "%"),
                column("evaluations", "evaluations"), column("time", "time", "s"), text_column("stop")});
  for (std::size_t m = 0; m < kMethods.size(); ++m)
    table.rows.push_back(
        {text_cell(kMethods[m]),
         fixed_cell(m == 0 ? 1135.332271 : 98.11878293 + 1e-6 * static_cast<double>(m), 6),
         m == 0 ? Cell{} : fixed_cell(-70.33, 2),
         m == 0 ? Cell{} : count_cell(39 * std::pow(6.0, static_cast<double>(m) - 1)),
         m == 0 ? Cell{} : significant_cell(0.07 * std::pow(4.0, static_cast<double>(m) - 1), 3),
         m == 0 ? Cell{} : text_cell(m < 3 ? "converged" : "max_evaluations")});
  return table;
}

}  // namespace

Table sample_table() {
  const double infinity = std::numeric_limits<double>::infinity();
  Table table = table_of("hard <cells>", "Cells that are \"hard\" & <b>not</b> markup",
                         {text_column("name"), column("value", "v_max", "m<2>"), text_column("remark")});
  table.notes = {"A note with <script>alert(1)</script> & co."};
  Cell marked = fixed_cell(118.125, 3);
  marked.difference = 5.625;
  marked.mark = "U";
  table.rows = {{text_cell("third"), fixed_cell(0.1 + 0.2, 3), text_cell("<i>text</i>")},
                {text_cell("marked"), marked, Cell{}},
                {text_cell("not a number"), fixed_cell(std::nan(""), 3), Cell{}},
                {text_cell("infinite"), fixed_cell(-infinity, 3), Cell{}},
                {text_cell("tiny"), significant_cell(4.9406564584124654e-324, 3), Cell{}},
                {text_cell("empty"), Cell{}, Cell{}}};
  return table;
}

Document sample_document() {
  std::mt19937_64 random(7);
  Document document;
  document.title = "Calibration of the demo robot";
  document.subtitle = "Six methods on five trajectories of five drives each, made-up data";
  document.datasets = {{"tracks", tracks_csv(random)},
                       {"errors", errors_csv(random)},
                       {"traces", traces_csv(random)},
                       {"correlations", correlations_csv()}};
  const Paragraph summary{
      "The calibrated parameters lower the total error by 70 %. All methods but the genetic algorithm end in "
      "the same "
      "point; what is left is noise of the measurements."};
  document.sections = {
      {"summary", "Summary", "What was found, in one table.", {summary, solvers_table()}},
      {"paths",
       "Paths",
       "Where the robot was, and where each method says it was.",
       {path_figure(), deviations_figure()}},
      {"errors",
       "Errors",
       "Largest, mean and scatter of the errors over the repetitions.",
       {errors_table(random), boxes_figure(), bars_figure(), histogram_figure()}},
      {"convergence", "Convergence", "How fast each method gets there.", {convergence_figure()}},
      {"parameters", "Parameters", "Which parameters the drives determine.", {heat_figure()}},
      {"details", "Details", "", {sample_table()}}};
  return document;
}

}  // namespace odobench::testing
