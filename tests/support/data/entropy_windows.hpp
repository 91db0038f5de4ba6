// Windows of the relative-entropy filter for tests: the reference ones, and random ones that need no file.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "datasets/entropy/entropy_window_file.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench::testing {

inline std::filesystem::path reference_windows_file() {
  return shared_folder() / "reference" / "entropy_windows.json";
}
inline std::vector<EntropyWindow> reference_windows() {
  return load_entropy_windows(reference_windows_file());
}
// What the independent evaluation says of them, in the same order.
inline nlohmann::json expected_of_windows() {
  std::ifstream file(reference_windows_file());
  return nlohmann::json::parse(file).at("windows");
}

// Noise of `noise` sigmas around a slow motion; balanced weights, so that no block of t is trivial.
inline EntropyWindow random_window(int samples, unsigned seed, double noise = 1) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  EntropyWindow window;
  window.id = "random" + std::to_string(seed);
  EntropyConstants& c = window.constants;
  c.samples = samples;
  c.sigma_encoder = 0.005;
  c.sigma_acceleration = 0.05;
  c.sigma_rotation = 0.2;
  c.step_acceleration = 0.05;
  c.step_rotation = 5;
  for (int n = 0; n < samples; ++n) {
    EntropySample s;
    for (std::size_t w = 0; w < 4; ++w) {
      s.wheel[w] = 0.05 + 0.002 * n + noise * c.sigma_encoder * normal(engine);
      s.steering[w] = 0.3 * normal(engine);
    }
    s.ax = 0.2 + noise * c.sigma_acceleration * normal(engine);
    s.ay = -0.1 + noise * c.sigma_acceleration * normal(engine);
    s.rotation = 0.4 + noise * c.sigma_rotation * normal(engine);
    window.samples.push_back(s);
  }
  return window;
}

// Random windows of several N in the format that bench reads.
inline std::string windows_json() {
  using nlohmann::json;
  json list = json::array();
  for (int i = 0; i < 6; ++i) {
    const EntropyWindow w = random_window(4 + i, static_cast<unsigned>(i));
    const EntropyConstants& c = w.constants;
    // One steering angle per wheel and window.
    json j = {
        {"id", w.id}, {"group", i < 3 ? "short" : "long"}, {"N", c.samples}, {"psi", {0.1, -0.2, 0.3, 0}}};
    j["params"] = {{"sigma_e", c.sigma_encoder},
                   {"sigma_a", c.sigma_acceleration},
                   {"sigma_theta", c.sigma_rotation},
                   {"L", c.wheel_distance},
                   {"dt", c.dt},
                   {"ilgis", 100 * c.length},
                   {"plotis", 100 * c.width},
                   {"step_a", c.step_acceleration},
                   {"step_z", c.step_rotation}};
    j["ce"] = json::array({json::array(), json::array(), json::array(), json::array()});
    for (const EntropySample& s : w.samples) {
      for (std::size_t k = 0; k < 4; ++k) j["ce"][k].push_back(s.wheel[k]);
      j["ax"].push_back(s.ax);
      j["ay"].push_back(s.ay);
      j["ctheta"].push_back(s.rotation);
    }
    list.push_back(j);
  }
  return json{{"format", "entropy-window-1"}, {"windows", list}}.dump();
}

}  // namespace odobench::testing
