#include "bench/studies/calibration/tracks_csv.hpp"

#include <fmt/format.h>

#include <iterator>

#include "reports/render/table.hpp"

namespace odobench {

std::string tracks_csv(const CalibrationProblem& problem, const std::vector<ParameterSet>& sets) {
  std::string text = "recording,parameters,time_s,x,y,theta,x_ref,y_ref,theta_ref\n";
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < problem.recordings().size(); ++i) {
    const Recording& r = problem.recordings()[i];
    for (const ParameterSet& set : sets) {
      const PoseTrack track = problem.integrate(i, set.values);
      const std::string key = csv_field(r.id) + "," + csv_field(set.label);
      for (std::size_t k = 0; k < r.size(); ++k)
        fmt::format_to(out, "{},{},{},{},{},{},{},{}\n", key, static_cast<double>(r.time_us[k]) * 1e-6,
                       track.x[k], track.y[k], track.theta[k], r.reference.x[k], r.reference.y[k],
                       r.reference.theta[k]);
    }
  }
  return text;
}

}  // namespace odobench
