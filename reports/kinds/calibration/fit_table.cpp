#include "reports/kinds/calibration/fit_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "reports/kinds/calibration/drive_tables.hpp"
#include "reports/kinds/calibration/table_parts.hpp"
#include "reports/records/series.hpp"

namespace odobench {
namespace {

// The row with the lowest J of those that are no nominal parameters; the nominal ones where there are no
// others.
const ComparisonRow* best_fit(const Comparison& comparison) {
  const ComparisonRow* best = nullptr;
  for (const ComparisonRow& row : comparison.rows) {
    if (&row == comparison.nominal() || !row.shown->cost || drive_fits(*row.shown).empty()) continue;
    if (best == nullptr || *row.shown->cost < *best->shown->cost) best = &row;
  }
  return best != nullptr ? best : comparison.nominal();
}

Cell fit_cell(double value, int digits, const double* nominal) {
  Cell cell = fixed_cell(value, digits);
  if (nominal != nullptr && std::isfinite(value - *nominal)) cell.difference = value - *nominal;
  return unless_infinite(std::move(cell));
}

std::vector<Cell> fit_row(const DriveFit& own, const DriveFit* nominal) {
  const auto cell = [&](double DriveFit::*member, double (*unit)(double), int digits) {
    const double before = nominal == nullptr ? 0 : unit(nominal->*member);
    return fit_cell(unit(own.*member), digits, nominal == nullptr ? nullptr : &before);
  };
  return {text_cell(own.recording), cell(&DriveFit::rms_position, in_millimetres, 3),
          cell(&DriveFit::rms_heading, in_degrees, 4), cell(&DriveFit::max_position, in_millimetres, 3)};
}

}  // namespace

double in_millimetres(double metres) {
  return 1000 * metres;
}

double in_degrees(double radians) {
  return radians / kDegree;
}

std::vector<DriveFit> drive_fits(const RunRecord& record) {
  std::array<const std::vector<double>*, kFitSeries.size()> series{};
  if (record.errors.empty()) return {};
  for (std::size_t k = 0; k < series.size(); ++k) {
    series[k] = series_of(record, kFitSeries[k], record.errors.size());
    if (series[k] == nullptr) return {};
  }
  std::vector<DriveFit> fits;
  for (std::size_t i = 0; i < record.errors.size(); ++i)
    fits.push_back(
        {record.errors[i].recording, (*series[0])[i], (*series[1])[i], (*series[2])[i], (*series[3])[i]});
  return fits;
}

DriveFit overall_fit(const std::vector<DriveFit>& fits) {
  DriveFit all{"all", 0, 0, 0, 0};
  for (const DriveFit& f : fits) {
    all.rms_position += f.samples * f.rms_position * f.rms_position;
    all.rms_heading += f.samples * f.rms_heading * f.rms_heading;
    all.max_position = std::max(all.max_position, f.max_position);
    all.samples += f.samples;
  }
  const double samples = std::max(all.samples, 1.0);
  all.rms_position = std::sqrt(all.rms_position / samples);
  all.rms_heading = std::sqrt(all.rms_heading / samples);
  return all;
}

std::optional<Table> fit_table(const Comparison& comparison) {
  const ComparisonRow* best = best_fit(comparison);
  if (best == nullptr) return std::nullopt;
  const std::vector<DriveFit> own = drive_fits(*best->shown);
  if (own.empty()) return std::nullopt;
  std::vector<DriveFit> nominal;
  if (comparison.nominal() != nullptr && best != comparison.nominal())
    nominal = drive_fits(*comparison.nominal()->shown);
  const bool compared = nominal.size() == own.size();
  Table table;
  table.id = comparison.id_prefix + "fit";
  table.title = fmt::format("How well the drives fit: {}{}", best->label, comparison.title_suffix);
  table.columns = {text_column("recording"), number_column("rms_position", "RMS position", "mm"),
                   number_column("rms_heading", "RMS heading", "deg"),
                   number_column("max_position", "largest", "mm")};
  if (own.size() <= kMostDriveRows)
    for (std::size_t i = 0; i < own.size(); ++i)
      table.rows.push_back(fit_row(own[i], compared ? &nominal[i] : nullptr));
  const DriveFit all = overall_fit(own), before = overall_fit(nominal);
  table.rows.push_back(fit_row(all, compared ? &before : nullptr));
  table.notes.push_back(
      fmt::format("Root mean squares over the samples with a reference, and the largest distance{}.",
                  compared ? "; in brackets: difference to nominal" : ""));
  return table;
}

}  // namespace odobench
