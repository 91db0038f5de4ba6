#include <fmt/format.h>

#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "reports/kinds/verification/verification_tables.hpp"

namespace odobench {

Estimate estimate(const std::vector<double>& values) {
  const ErrorStatistics s = error_statistics_of(values);
  if (values.size() < 2 || std::isnan(s.mean)) return {s.mean, std::nullopt};
  const auto n = static_cast<double>(values.size());
  const boost::math::students_t distribution(n - 1);
  return {s.mean, boost::math::quantile(distribution, 0.975) * s.sigma / std::sqrt(n)};
}

std::vector<double> picked(const std::vector<VerifyOutcome>& outcomes, const Pick& pick) {
  std::vector<double> values;
  for (const VerifyOutcome& o : outcomes) values.push_back(pick(o));
  return values;
}

namespace {

constexpr int kVerifyDigits = 6;  // as in the thesis

class TableMaker {
 public:
  explicit TableMaker(const VerificationRounds& v) : labels_(v.labels), outcomes_(v.outcomes) {}

  Table start(std::string id, std::string title) const {
    Table t{
        std::move(id), std::move(title), {key("parameters")}, {}, {}, {0}};  // differences are to the first
    for (const std::string& label : labels_) t.rows.push_back({text_cell(label)});
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
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      const Estimate e = estimate(picked(outcomes_[i], pick));
      Cell cell = std::isnan(e.mean) ? Cell{} : fixed_cell(e.mean, kVerifyDigits);
      if (i > 0 && !std::isnan(e.mean) && !std::isnan(nominal)) cell.difference = e.mean - nominal;
      cell.noise = e.half_width.value_or(std::numeric_limits<double>::infinity());
      t.rows[i].push_back(std::move(cell));
      t.rows[i].push_back(e.half_width ? fixed_cell(*e.half_width, kVerifyDigits) : Cell{});
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
    for (std::size_t i = 0; i < labels_.size(); ++i) {
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
  const std::vector<std::string>& labels_;
  const std::vector<std::vector<VerifyOutcome>>& outcomes_;
};

constexpr std::array<const char*, 3> kPoseUnits{"m", "m", "rad"};
constexpr std::array<const char*, 3> kPoseSymbols{"x", "y", "θ"};

Table new_drive_table(const TableMaker& maker, const std::string& drive, std::size_t t) {
  Table table = maker.start("verify." + drive, fmt::format("New drives of trajectory {}", drive));
  for (std::size_t v = 0; v < 3; ++v) {
    const std::string id = kPoseVariables[v], name = kPoseSymbols[v], unit = kPoseUnits[v];
    maker.add(table, "e_max_" + id, fmt::format("e_{},max", name), unit, id,
              [t, v](const VerifyOutcome& o) { return o.errors.at(t).variables[v].max; });
    maker.add(table, "e_sr_" + id, fmt::format("e_{},sr", name), unit, id,
              [t, v](const VerifyOutcome& o) { return o.errors.at(t).variables[v].mean; });
    maker.add(table, "sigma_" + id, fmt::format("σ_{}", name), unit, id,
              [t, v](const VerifyOutcome& o) { return o.errors.at(t).variables[v].sigma; });
  }
  return table;
}

Table new_totals_table(const TableMaker& maker, std::size_t repeats) {
  Table table = maker.start("verify.totals", "Total error of the new drives");
  for (std::size_t v = 0; v < 3; ++v)
    maker.add(table, fmt::format("sum_e_sr_{}", kPoseVariables[v]), fmt::format("Σ e_{},sr", kPoseSymbols[v]),
              kPoseUnits[v], kPoseVariables[v], [v](const VerifyOutcome& o) { return o.totals.sums[v]; });
  maker.add(table, "total", "total", "", "total", [](const VerifyOutcome& o) { return o.totals.total; });
  maker.add_change(table);
  table.notes.push_back(
      fmt::format("Means over {} repeats of all drives, ±: half the width of their 95 % interval; in "
                  "brackets: difference to nominal. "
                  "Errors: odometry by the set against motion capture, on drives steered by the same set.",
                  repeats));
  return table;
}

Table interval_table(const TableMaker& maker, const std::vector<std::string>& drives) {
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

}  // namespace

std::vector<Table> verification_tables(const VerificationRounds& rounds) {
  const TableMaker maker(rounds);
  std::vector<Table> tables;
  for (std::size_t t = 0; t < rounds.drives.size(); ++t)
    tables.push_back(new_drive_table(maker, rounds.drives[t], t));
  tables.push_back(new_totals_table(maker, rounds.outcomes.front().size()));
  for (const std::string& note : rounds.notes) tables.back().notes.push_back(note + ".");
  tables.push_back(interval_table(maker, rounds.drives));
  return tables;
}

}  // namespace odobench
