#include "bench/verbs/verify.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/studies/planning/verification.hpp"
#include "bench/studies/run_folder.hpp"
#include "bench/verbs/common_options.hpp"

namespace odobench {
namespace {

struct VerifyOptions {
  VerificationStudy study;
  std::string out;  // folder for records and tables; empty: none
  bool overwrite = false;
  std::string format = "console";
};

void add_options(CLI::App& app, VerifyOptions& o) {
  add_scenario(app, "--scenario", o.study.scenario);
  app.add_option("--parameters", o.study.parameters,
                 "JSON files, 'nominal', 'truth' or 'believed'; a comma list, may be given again")
      ->required()
      ->type_name("LIST")
      ->allow_extra_args(false);
  add_count(app, "--repeat", o.study.repeat, 1, 10000, "times that all drives are driven [10]");
  add_noise_options(app, o.study.seed, o.study.threads);
  add_kernel(app, o.study.kernel, kNamedOnly);
  add_study_folder(app, o.out, o.overwrite);
  add_format(app, o.format);
}

constexpr int kErrorDigits = 6;  // as in the thesis

class TableMaker {
 public:
  explicit TableMaker(const Verification& v) : sets_(v.sets), outcomes_(v.outcomes) {}

  Table start(std::string id, std::string title) const {
    Table t{
        std::move(id), std::move(title), {key("parameters")}, {}, {}, {0}};  // differences are to the first
    for (const ParameterSet& set : sets_) t.rows.push_back({text_cell(set.label)});
    return t;
  }
  // Two columns: the mean, with its difference to nominal, and its interval.
  void add(Table& t, const std::string& id, const std::string& name, const std::string& unit,
           const std::string& group, const Pick& pick) const {
    Column mean = key(id), interval = key(id + "_ci95");
    mean.align = interval.align = Align::Right;
    mean.name = name;
    interval.name = "±";
    mean.unit = interval.unit = unit;
    mean.group = interval.group = group;
    t.columns.push_back(best_if(Better::Lower, std::move(mean)));
    t.columns.push_back(std::move(interval));
    const double nominal = estimate(picked(outcomes_.front(), pick)).mean;
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      const Estimate e = estimate(picked(outcomes_[i], pick));
      Cell cell = std::isnan(e.mean) ? Cell{} : fixed_cell(e.mean, kErrorDigits);
      if (i > 0 && !std::isnan(e.mean) && !std::isnan(nominal)) cell.difference = e.mean - nominal;
      cell.noise = e.half_width.value_or(std::numeric_limits<double>::infinity());
      t.rows[i].push_back(std::move(cell));
      t.rows[i].push_back(e.half_width ? fixed_cell(*e.half_width, kErrorDigits) : Cell{});
    }
  }
  // Change to nominal in %, drive against the same drive.
  void add_change(Table& t) const {
    Column mean = key("change_percent"), interval = key("change_percent_ci95");
    mean.align = interval.align = Align::Right;
    mean.name = "change";
    interval.name = "±";
    mean.unit = interval.unit = "%";
    t.columns.push_back(std::move(mean));
    t.columns.push_back(std::move(interval));
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      std::vector<double> changes;
      for (std::size_t k = 0; k < outcomes_[i].size(); ++k)
        changes.push_back(100 * (outcomes_[i][k].totals.total / outcomes_[0][k].totals.total - 1));
      const Estimate e = estimate(changes);
      t.rows[i].push_back(i > 0 ? fixed_cell(e.mean, 2) : Cell{});
      t.rows[i].push_back(i > 0 && e.half_width ? fixed_cell(*e.half_width, 2) : Cell{});
    }
  }

 private:
  static Column key(const std::string& id) {
    Column c;
    c.id = c.name = id;
    c.align = Align::Left;
    return c;
  }
  const std::vector<ParameterSet>& sets_;
  const std::vector<std::vector<VerifyOutcome>>& outcomes_;
};

constexpr std::array<const char*, 3> kUnits{"m", "m", "rad"};
constexpr std::array<const char*, 3> kShort{"x", "y", "θ"};

Table trajectory_table(const TableMaker& maker, const std::string& drive, std::size_t t) {
  Table table = maker.start("verify." + drive, fmt::format("New drives of trajectory {}", drive));
  for (std::size_t v = 0; v < 3; ++v) {
    const std::string id = kPoseVariables[v], name = kShort[v], unit = kUnits[v];
    maker.add(table, "e_max_" + id, fmt::format("e_{},max", name), unit, id,
              [t, v](const VerifyOutcome& o) { return o.errors.at(t).variables[v].max; });
    maker.add(table, "e_sr_" + id, fmt::format("e_{},sr", name), unit, id,
              [t, v](const VerifyOutcome& o) { return o.errors.at(t).variables[v].mean; });
    maker.add(table, "sigma_" + id, fmt::format("σ_{}", name), unit, id,
              [t, v](const VerifyOutcome& o) { return o.errors.at(t).variables[v].sigma; });
  }
  return table;
}

Table totals_table(const TableMaker& maker, int repeats) {
  Table table = maker.start("verify.totals", "Total error of the new drives");
  for (std::size_t v = 0; v < 3; ++v)
    maker.add(table, fmt::format("sum_e_sr_{}", kPoseVariables[v]), fmt::format("Σ e_{},sr", kShort[v]),
              kUnits[v], kPoseVariables[v], [v](const VerifyOutcome& o) { return o.totals.sums[v]; });
  maker.add(table, "total", "total", "", "total", [](const VerifyOutcome& o) { return o.totals.total; });
  maker.add_change(table);
  table.notes.push_back(
      fmt::format("Means over {} repeats of all drives, ±: half the width of their 95 % interval; in "
                  "brackets: difference to nominal. "
                  "Errors: odometry by the set against motion capture, on drives steered by the same set.",
                  repeats));
  return table;
}

Table arrival_table(const TableMaker& maker, const std::vector<std::string>& drives) {
  Table table = maker.start("verify.arrival", "How far from the reference's end the robot really stopped");
  for (std::size_t t = 0; t < drives.size(); ++t) {
    const std::string& name = drives[t];
    maker.add(table, "position_" + name, name, "m", name,
              [t](const VerifyOutcome& o) { return o.arrival[t][0]; });
    maker.add(table, "heading_" + name, "heading", "rad", name,
              [t](const VerifyOutcome& o) { return o.arrival[t][1]; });
  }
  return table;
}

std::vector<Table> tables_of(const Verification& v, int repeats) {
  const TableMaker maker(v);
  std::vector<Table> tables;
  for (std::size_t t = 0; t < v.drives.size(); ++t) tables.push_back(trajectory_table(maker, v.drives[t], t));
  tables.push_back(totals_table(maker, repeats));
  tables.push_back(arrival_table(maker, v.drives));
  return tables;
}

ExitCode verify_command(const VerifyOptions& o) {
  const Format format = parse_format(o.format);
  RunFolder folder(o.out, o.overwrite);
  folder.require_free();
  TerminalWatcher watcher;
  const Verification v = verify_parameters(o.study, watcher, InterruptGuard::stop());
  const std::vector<Table> tables = tables_of(v, o.study.repeat);
  folder.keep(v.records, tables, watcher);
  print_tables(tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_verify(CLI::App& app) {
  return verb_action<VerifyOptions>(app, add_options, verify_command);
}

}  // namespace odobench
