// Run records for the tests of reports/: made by hand, or from the published reference values.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reports/records/record.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench::testing {

// A run of one parameter "p" without errors.
inline RunRecord run_record(const std::string& label, double cost, int repetition = 1) {
  RunRecord r;
  r.problem = "sphere";
  r.label = r.solver = label;
  r.kind = "run";
  r.repetition = repetition;
  r.start = "nominal";
  r.random = label.rfind("pso", 0) == 0 || label.rfind("ga", 0) == 0;
  r.termination = "converged";
  r.message = "gradient 1e-11 <= 1e-10";
  r.cost = cost;
  r.evaluations = 10 * repetition;
  r.iterations = 5;
  r.seconds = 0.25;
  return r;
}

// One recording per entry of `x`; y and theta follow from it by factors 2 and 3.
inline void add_errors(RunRecord& r, const std::string& trajectory, const std::vector<double>& x) {
  for (std::size_t n = 0; n < x.size(); ++n)
    r.errors.push_back({trajectory + "_" + std::to_string(n + 1),
                        trajectory,
                        static_cast<int>(n + 1),
                        {x[n], 2 * x[n], 3 * x[n]}});
}

inline RunRecord calibration_record(const std::string& label, const std::string& kind, double cost,
                                    double error) {
  RunRecord r = run_record(label, cost);
  r.problem = "calibration";
  r.dataset = "demo";
  r.kind = kind;
  if (kind == "evaluation") r.termination = r.message = "";
  r.parameters = {{"a1", "m", label == "nominal" ? 0.1125 : 0.118125, 0.1125, 0.106875, 0.118125,
                   label == "nominal" ? "" : "upper"},
                  {"r1", "m", 0.0254, 0.0254, 0.02413, 0.02667, ""}};
  add_errors(r, "line_x", {error, 3 * error});
  add_errors(r, "circle", {2 * error, 2 * error});
  return r;
}

inline nlohmann::json reference_json(const std::string& name) {
  std::ifstream stream(shared_folder() / "reference" / name);
  return nlohmann::json::parse(stream);
}

// The sets of calibration_vitko2024.json as evaluations: "nominal" and "published:NAME".
inline std::vector<RunRecord> reference_records(const nlohmann::json& reference) {
  const std::vector<std::string> trajectories{"line_x",    "line_y",       "circle_ccw",
                                              "circle_cw", "rotation_ccw", "rotation_cw"};
  std::vector<RunRecord> records;
  for (const auto& [name, set] : reference.at("sets").items()) {
    RunRecord r;
    r.problem = "calibration";
    r.dataset = "vitko2024";
    r.label = name == "nominal" ? name : "published:" + name;
    r.kind = "evaluation";
    r.cost = set.at("J").get<double>();
    for (const std::string& trajectory : trajectories) {
      const auto& cells = set.at("errors").at(trajectory);
      for (std::size_t n = 0; n < 5; ++n)
        r.errors.push_back({trajectory + "_" + std::to_string(n + 1),
                            trajectory,
                            static_cast<int>(n + 1),
                            {cells.at("x").at("per_repetition").at(n).get<double>(),
                             cells.at("y").at("per_repetition").at(n).get<double>(),
                             cells.at("theta").at("per_repetition").at(n).get<double>()}});
    }
    records.push_back(r);
  }
  return records;
}

}  // namespace odobench::testing
