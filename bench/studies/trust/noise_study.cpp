#include "bench/studies/trust/noise_study.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace odobench {
namespace {

// One sentence per reason, with the terms that it keeps from being told.
void say_undetermined(const NoiseFit& fit, std::vector<std::string>& remarks) {
  std::vector<std::string> reasons;
  for (const NoiseEstimate& e : fit.terms)
    if (!e.undetermined.empty() && std::find(reasons.begin(), reasons.end(), e.undetermined) == reasons.end())
      reasons.push_back(e.undetermined);
  for (const std::string& reason : reasons) {
    std::string names;
    for (std::size_t t = 0; t < fit.terms.size(); ++t)
      if (fit.terms[t].undetermined == reason)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", noise_terms()[t].name);
    remarks.push_back(fmt::format("noise of the odometry: {} not determined: {}", names, reason));
  }
}

}  // namespace

NoiseFigures figures_of(const NoiseFit& fit, const NoiseModel& total) {
  NoiseFigures f;
  for (std::size_t t = 0; t < fit.terms.size(); ++t) {
    const NoiseEstimate& e = fit.terms[t];
    if (e.undetermined.empty())
      f.terms.push_back(
          {noise_terms()[t].name, noise_terms()[t].unit, e.value, e.lower, e.upper, total.value[t]});
  }
  f.speed = fit.typical.speed;
  f.turn_rate = fit.typical.turn_rate;
  f.metres = fit.metres;
  f.radians = fit.radians;
  f.drives = fit.drives;
  f.separated = fit.separated;
  f.checked = fit.checked;
  f.nees = fit.nees;
  f.nees_lower = fit.nees_lower;
  f.nees_upper = fit.nees_upper;
  for (const NoiseKind& k : fit.kinds)
    f.kinds.push_back({k.trajectory, static_cast<double>(k.drives), k.repeated ? 1.0 : 0.0, k.bias[0],
                       k.bias[1], k.bias[2], k.scatter[0], k.scatter[1], k.scatter[2], k.predicted[0],
                       k.predicted[1], k.predicted[2], k.nees});
  for (const NoiseLength& l : fit.lengths)
    f.lengths.push_back({l.metres, l.radians, static_cast<double>(l.segments), l.ratio});
  return f;
}

std::vector<std::string> describe_noise(const LoadedProblem& loaded, RunRecord& record) {
  std::vector<std::string> remarks;
  if (!loaded.calibration || record.parameters.size() != loaded.calibration->parameters().size())
    return remarks;
  if (loaded.dataset->reference == ReferenceKind::Headings)
    return {"noise of the odometry: not estimated: a gyro measures no positions"};
  Vector z(static_cast<Eigen::Index>(record.parameters.size()));
  for (std::size_t i = 0; i < record.parameters.size(); ++i)
    z[static_cast<Eigen::Index>(i)] = record.parameters[i].value;
  const std::vector<NoiseDrive> drives = noise_drives(*loaded.calibration, z);
  const NoiseFit fit = fit_odometry_noise(drives);
  if (!fit.refused.empty()) return {fmt::format("noise of the odometry: not estimated: {}", fit.refused)};
  NoiseModel total = fit.model;
  if (fit.separated) total = fit_odometry_noise(drives, {false, false, true}).model;
  put_noise(figures_of(fit, total), record);
  say_undetermined(fit, remarks);
  if (fit.checked > 0 && !fit.consistent())
    remarks.push_back(
        fmt::format("noise of the odometry: left-out drives have NEES {:.2f}, expected {:.2f} .. "
                    "{:.2f}: {}",
                    fit.nees, fit.nees_lower, fit.nees_upper,
                    fit.nees > fit.nees_upper ? "believe it less than it says"
                                              : "it is more cautious than it has to be"));
  return remarks;
}

}  // namespace odobench
