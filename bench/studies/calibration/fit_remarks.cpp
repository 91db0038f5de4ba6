#include "bench/studies/calibration/fit_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "reports/kinds/calibration/fit_table.hpp"
#include "reports/statistics/statistics.hpp"

namespace odobench {
namespace {

constexpr double kShare = 0.5, kTimesMedian = 5;
constexpr double kGrown = 1e-6;  // relative: less is rounding

void remark_on_total(const RunRecord& record, const RunRecord& nominal, std::vector<std::string>& remarks) {
  const double now = error_totals(error_statistics(record.errors)).total,
               before = error_totals(error_statistics(nominal.errors)).total;
  if (!(now > before * (1 + kGrown))) return;
  remarks.push_back(
      fmt::format("the total error grows from {:.4g} with nominal parameters to {:.4g} with those of "
                  "{}: the calibration does not help",
                  before, now, record.label));
}

void remark_on_bounds(const RunRecord& record, std::vector<std::string>& remarks) {
  std::size_t free = 0, bound = 0;
  for (const ParameterValue& p : record.parameters) {
    if (p.lower < p.upper) ++free;
    if (!p.at_bound.empty()) ++bound;
  }
  if (bound < 2 || 2 * bound < free) return;
  remarks.push_back(
      fmt::format("{} of {} free parameters sit on bounds: the box, or something about the drives, "
                  "decides the result",
                  bound, free));
}

void remark_on_drive(const CalibrationOptions& options, const RunRecord& record,
                     std::vector<std::string>& remarks) {
  const std::vector<DriveFit> fits = drive_fits(record);
  if (fits.size() < 3) return;
  std::vector<double> parts;
  for (const DriveFit& f : fits)
    parts.push_back(f.samples * (options.position_weight * f.rms_position * f.rms_position +
                                 options.heading_weight * f.rms_heading * f.rms_heading));
  const auto most = std::max_element(parts.begin(), parts.end());
  const double all = std::accumulate(parts.begin(), parts.end(), 0.0), usual = spread(parts).median;
  if (!(*most > kShare * all) || !(*most > kTimesMedian * usual)) return;
  const DriveFit& fit = fits[static_cast<std::size_t>(most - parts.begin())];
  remarks.push_back(fmt::format(
      "the drive {} makes {:.0f} % of the squared errors ({:.3g} mm and {:.3g} deg RMS): look "
      "at it, or leave it out{}",
      fit.recording, 100 * *most / all, in_millimetres(fit.rms_position), in_degrees(fit.rms_heading),
      options.loss.robust() ? "" : "; --loss=cauchy counts large errors for less"));
}

}  // namespace

std::vector<std::string> fit_remarks(const LoadedProblem& loaded, const RunRecord& record,
                                     const RunRecord& nominal) {
  std::vector<std::string> remarks;
  if (!loaded.calibration || record.errors.empty()) return remarks;
  remark_on_total(record, nominal, remarks);
  remark_on_bounds(record, remarks);
  remark_on_drive(loaded.calibration->options(), record, remarks);
  return remarks;
}

}  // namespace odobench
