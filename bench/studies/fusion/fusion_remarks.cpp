#include "bench/studies/fusion/fusion_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace odobench {
namespace {

constexpr double kMostRejected = 0.2;
constexpr double kSure = 3;      // standard deviations of a mean
constexpr double kWorse = 1.05;  // times the wheels' error

void add_gate(const FusionSensorRow& sensor, std::vector<std::string>& remarks) {
  const double judged = sensor.used + sensor.rejected;
  if (!(judged > 0) || sensor.rejected <= kMostRejected * judged) return;
  remarks.push_back(
      fmt::format("the gate rejects {:.0f} % of {}: what the filter believes of it, or of what it "
                  "is compared with, is wrong",
                  100 * sensor.rejected / judged, sensor.name));
}

void add_bias(const SensorsFile& file, const FusionSensorRow& sensor, std::vector<std::string>& remarks) {
  if (file.options.gyro_bias || !(sensor.innovation_rms > 0) || !(sensor.innovation_noise > 0)) return;
  if (sensor.innovation_rms <= kSure * sensor.innovation_noise) return;
  remarks.push_back(fmt::format(
      "{} differs from the wheels by {:.2g} rad/s ({:.2g} deg/s) on the average of a drive: this looks like "
      "a "
      "bias; \"gyro_bias\": {{\"initial\": {:.1g}, \"walk\": 1e-4}} in the sensors' file estimates it",
      sensor.name, sensor.innovation_rms, sensor.innovation_rms / kDegree, sensor.innovation_rms));
}

}  // namespace

std::vector<std::string> fusion_remarks(const SensorsFile& file, const FusionRow& row,
                                        const FusionRow* wheels) {
  std::vector<std::string> remarks;
  if (!row.filtered) return remarks;
  for (const FusionSensorRow& sensor : row.sensors) {
    add_gate(sensor, remarks);
    add_bias(file, sensor, remarks);
  }
  if (wheels == nullptr) return remarks;
  std::string worse;
  if (row.rmse_position > kWorse * wheels->rmse_position)
    worse = fmt::format("position {:.3g} m against {:.3g}", row.rmse_position, wheels->rmse_position);
  if (row.rmse_heading > kWorse * wheels->rmse_heading)
    worse += fmt::format("{}heading {:.3g} deg against {:.3g}", worse.empty() ? "" : ", ",
                         row.rmse_heading / kDegree, wheels->rmse_heading / kDegree);
  if (!worse.empty()) remarks.push_back("worse than the wheels alone: " + worse + " (root mean square)");
  return remarks;
}

}  // namespace odobench
