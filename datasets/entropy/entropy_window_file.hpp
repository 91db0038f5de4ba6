// Windows of the relative-entropy filter from a JSON file,
//   {"format": "entropy-window-1", "windows": [{"id", "group", "N",
//       "params": {"sigma_e", "sigma_a", "sigma_theta", "L", "dt", "ilgis", "plotis", "step_a", "step_z"},
//       "psi": [4], "ce": [4][N], "ax": [N], "ay": [N], "ctheta": [N]}, ...]}
// in the units of the format: sigma_e, L, ce in m, sigma_a, step_a, ax, ay in m/s^2, sigma_theta, ctheta in
// deg, step_z in deg/s^2, dt in s, ilgis (length) and plotis (width) in cm, psi in rad, constant in the
// window. Further keys (reference results) are passed over; "group" may be absent.
#pragma once

#include <filesystem>
#include <vector>

#include "datasets/entropy/entropy_window.hpp"

namespace odobench {

// Not empty, ids unique. Throws DataError with file and JSON path: a missing or mistyped value, an array of
// another length, N < 3, a sigma, dt, size or step that is not > 0.
std::vector<EntropyWindow> load_entropy_windows(const std::filesystem::path& file);

}  // namespace odobench
