// What each verb was asked to do, as plain data: filled by cli.cpp, read by the *_command files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "datasets/entropy/entropy_window.hpp"
#include "problems/instruction_set.hpp"
#include "solvers/run.hpp"

namespace odobench {

// Ends runs whose method would go on for very long; --max-evals=none lifts it.
inline constexpr std::int64_t kDefaultMaxEvaluations = 50000;

struct RunOptions {
  std::vector<std::string> solvers;   // each a comma list as typed; empty: lm,ip,ga,pso
  std::string data;                   // path of set.json; empty: the demo set
  std::vector<std::string> problems;  // each a comma list of names and patterns; empty: calibration
  int dimension = 0;                  // of classic problems; 0: their usual ones
  bool check_derivatives = false;
  int repeat = 1;
  std::uint64_t seed = 1;
  int threads = 0;                       // 0: one per core
  std::optional<InstructionSet> kernel;  // none: kernel_in_force() knows
  Budget budget{kDefaultMaxEvaluations};
  std::string start = "nominal";
  std::string polish;  // solver, as typed; empty: none
  std::string out;     // folder for records and tables; empty: none
  bool overwrite = false;
  std::string format = "console";
  bool quiet = false;
};

// Where the thesis' program and the corrected filter differ; what is not set follows FilterOptions::as_published.
struct FilterOptions {
  std::string data;                   // CSV file, "-" for standard input
  std::string truth;                  // CSV file; empty: none
  std::string solver = "coordinate";  // coordinate, exact, relaxed, zero, or any of the registry as typed
  std::string out;                    // CSV file; empty: none
  std::string records;                // folder for the run record and tables; empty: none
  std::vector<std::string> columns, truth_columns;  // name=column lists as typed
  bool as_published = false;
  std::optional<std::string> theta;                // of the thesis' layout: step-deg, ..., raw
  std::optional<std::string> accelerometer_frame;  // robot | filter
  std::optional<bool> omega_cross_v;
  std::optional<std::string> wheel_order;  // right-first | left-first
  std::optional<double> dt;                // s; none: from time_s
  double time_tolerance = 0.01;            // relative
  EntropyConstants constants;              // dt and step_rotation apart
  std::optional<double> step_rotation;     // deg/s^2
  bool gap = false;                        // compare with exact and relaxed
  std::optional<InstructionSet> kernel;
  std::uint64_t seed = 1;
  Budget budget{kDefaultMaxEvaluations};  // per window, of a solver of the registry
  bool overwrite = false;
  std::string format = "console";
  bool quiet = false;
};

struct WindowsOptions {
  std::string file;
  std::vector<std::string> solvers;  // each a comma list as typed; empty: coordinate,exact,relaxed
  std::vector<std::string> only;     // comma lists of ids or groups; empty: all windows
  int repeat = 1;
  std::uint64_t seed = 1;
  int threads = 0;  // 0: one per core
  std::optional<InstructionSet> kernel;
  Budget budget{kDefaultMaxEvaluations};
  std::string out;  // folder for records and tables; empty: none
  bool overwrite = false;
  std::string format = "console";
  bool quiet = false;
};

struct EvaluateOptions {
  std::string data;
  std::vector<std::string> parameters;  // files or names, as typed; empty: nominal
  std::string tracks;                   // CSV file for the paths; empty: none
  std::optional<InstructionSet> kernel;
  std::string out;  // folder for records, tables and tracks; empty: none
  bool overwrite = false;
  std::string format = "console";
};

struct ListOptions {
  std::string what;  // solvers | problems | data | scenarios
  std::string data;  // with `data`, `scenarios`: the one to describe; empty: known places
  std::string format = "console";
};

struct ImportOptions {
  std::string source;  // name of the importer, "vitko2024"
  std::string from;
  std::string out;
  bool overwrite = false;
  bool drop_lost = false;  // captured samples whose tracking was lost
  bool quiet = false;
  bool json = false;  // say on standard output what was written
};

struct DemoOptions {
  std::string out;
  std::optional<std::uint64_t> seed;  // of the noise; none: that of the demo set in the repository
  bool overwrite = false;
  bool json = false;  // say on standard output what was written
};

struct SimulateOptions {
  std::string scenario;  // file or name
  std::string out;
  std::uint64_t seed = 1;
  bool raw = false;           // the published CSV format instead of a data set
  bool as_published = false;  // dynamics without the corrections
  int threads = 0;            // 0: one per core
  bool overwrite = false;
  bool quiet = false;
  bool json = false;  // say on standard output what was written
};

struct PlanOptions {
  std::string robot;                    // scenario: file or name
  std::vector<std::string> drives;      // comma lists; empty: those of the scenario
  std::vector<std::string> candidates;  // comma lists to choose from; empty: no proposals
  double wanted = 0.005;                // relative standard deviation
  int replicas = 32;                    // fewer miss the rare late messages that decide
  std::uint64_t seed = 1;
  int threads = 0;
  std::optional<InstructionSet> kernel;
  std::string format = "console";
};

struct VerifyOptions {
  std::string scenario;
  std::vector<std::string> parameters;  // files or names, comma lists
  int repeat = 10;
  std::uint64_t seed = 1;
  int threads = 0;
  std::optional<InstructionSet> kernel;
  std::string format = "console";
};

struct CheckOptions {
  std::string baseline;
  std::vector<std::string> runs;  // folders or .jsonl files
  bool update = false;
  std::string format = "console";
};

struct ReportOptions {
  std::vector<std::string> runs;
  std::string out;      // HTML page, "-" for standard output; empty: none
  std::string figures;  // folder for SVG files; empty: none
  std::string title;    // of the page; empty: what was run
  bool overwrite = false;
  std::string format = "console";
};

struct ExportOptions {
  std::string run;  // folder
  bool tum = false;
  std::string out;  // folder
  bool overwrite = false;
  bool json = false;
};

}  // namespace odobench
