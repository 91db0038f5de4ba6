// parameters/LABEL.json of a run directory: what each row found, for --parameters, `bench export` and people.
//
//   {"schema": "odobench-parameters", "schema_version": 1, "name": LABEL,
//    "values": {NAME: value, ..},                        what --parameters=FILE reads
//    "parameters": [{"name", "unit", "nominal", "lower", "upper", "interval", "at_bound"}, ..],
//    "robot": {"name", "kinematics", "ties": {NAME: NAME}, "wheels": [..], "nominal_wheels": [..]},
//    "noise": {..},                                      of the odometry (parameter_noise.hpp), or absent
//    "run": {"id", "problem", "dataset", "dataset_sha256", "solver", "cost", "time_utc"}}
// interval: {"half_width", "df", "decided_by"}: of 95 %, in the parameter's unit; null with the reason in
// words where there is none ("decided by the box: ..."). sd_if_samples_were_independent stands beside it
// where the record has it; no interval is made of that. Files of earlier versions, which call it
// standard_deviation, are read and have no intervals. wheels: the table of datasets/robots/wheel.hpp at these
// values, each with its fields, "drive" (names of signals) and "steering".
// id: the first 12 digits of the SHA-256 of the run's line in runs.jsonl. Problems that are no calibration
// have no "robot".
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/catalogue/problem_factory.hpp"
#include "datasets/robots/wheel.hpp"
#include "reports/kinds/trust/noise_record.hpp"
#include "reports/records/record.hpp"

namespace odobench {

inline constexpr const char* kParameterSchema = "odobench-parameters";
inline constexpr int kParameterSchemaVersion = 1;
inline constexpr const char* kParameterFolder = "parameters";  // of a run directory

struct FoundParameter {
  ParameterValue parameter;
  std::optional<double> half_width;  // of the 95 % interval, in the parameter's unit
  std::optional<double> df = {};     // degrees of freedom of it
  std::string decided_by = {};       // why there is none, in words
  std::optional<double> sd_if_samples_were_independent = {};
};

struct ParameterFile {
  std::string label;
  std::vector<FoundParameter> parameters;
  std::string robot, kinematics;  // "": no calibration
  std::vector<std::pair<std::string, std::string>> ties;
  std::vector<Wheel> wheels, nominal_wheels;
  std::optional<NoiseFigures> noise;
  std::string run_id, problem, dataset, dataset_sha256, solver, time_utc;
  std::optional<double> cost;
};

// Of a record with parameters of this problem.
ParameterFile parameter_file(const LoadedProblem& loaded, const RunRecord& record);

std::string to_json_text(const ParameterFile& file);
// Throws DataError "file: /place: found ..., expected ...".
ParameterFile read_parameter_file(const std::filesystem::path& file);

// Name (below the run directory) and bytes of the best run by J of each label; nominal parameters have none.
// With several problems each has a folder of its own.
std::vector<std::pair<std::filesystem::path, std::string>> parameter_files(
    const std::vector<LoadedProblem>& loaded, const std::vector<RunRecord>& records);

// All *.json of the run directory's folder and of the folders in it, in the order of their names; none where
// there is no such folder.
std::vector<std::filesystem::path> stored_parameter_files(const std::filesystem::path& run_directory);

}  // namespace odobench
