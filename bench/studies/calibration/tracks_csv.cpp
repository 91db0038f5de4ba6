#include "bench/studies/calibration/tracks_csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "datasets/native/columns.hpp"
#include "reports/render/table.hpp"

namespace odobench {

std::string tracks_csv(const CalibrationProblem& problem, const std::vector<ParameterSet>& sets) {
  std::string text = "recording,parameters,time_s,x,y,theta,x_ref,y_ref,theta_ref\n";
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < problem.recordings().size(); ++i) {
    const Recording r = with_reference_everywhere(problem.recordings()[i]);
    // No number where there is no reference.
    const auto cell = [](double value) {
      return std::isnan(value) ? std::string() : fmt::format("{}", value);
    };
    for (const ParameterSet& set : sets) {
      const PoseTrack track = problem.integrate(i, set.values);
      const std::string key = csv_field(r.id) + "," + csv_field(set.label);
      for (std::size_t k = 0; k < r.size(); ++k)
        fmt::format_to(out, "{},{},{},{},{},{},{},{}\n", key, static_cast<double>(r.time_us[k]) * 1e-6,
                       track.x[k], track.y[k], track.theta[k], cell(r.reference.x[k]), cell(r.reference.y[k]),
                       cell(r.reference.theta[k]));
    }
  }
  return text;
}

}  // namespace odobench
