#include "tests/support/formats.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <stdexcept>

#include "base/sha256.hpp"
#include "base/text.hpp"
#include "datasets/dataset.hpp"
#include "datasets/native/recording_file.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "tests/support/data/entropy_windows.hpp"
#include "tests/support/data/filter_run_files.hpp"
#include "tests/support/data/synthetic_recording.hpp"
#include "tests/support/in_process.hpp"
#include "tests/support/log_formats.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench::testing {
namespace {

namespace fs = std::filesystem;

constexpr int kSamples = 12;

Dataset tiny_dataset() {
  Dataset d;
  d.name = "tiny";
  d.robot = robot_4wis4wid();
  d.trajectories = {{"synthetic", "made up"}};
  d.recordings = {synthetic_recording(kSamples, 0.05, 1), synthetic_recording(kSamples, 0.05, 2)};
  d.known_parameters = {{"truth", "", {}}};
  for (const RobotParameter& p : d.robot.parameters) d.known_parameters[0].values.push_back(p.nominal);
  return d;
}

// Made once: examples of formats that only the program writes.
const TemporaryFolder& prepared() {
  static const TemporaryFolder folder;
  static const bool made = [] {
    const auto run = [](Words words) {
      const ProcessResult result = bench_in_process(words);
      if (result.exit_code != 0) throw std::runtime_error("cannot prepare examples: " + result.err);
    };
    save_dataset(tiny_dataset(), folder / "set.json", true);
    save_dataset(tiny_dataset(), folder / "files.json");
    run({"--data=" + (folder / "set.json").string(), "--solver=lm,ga", "--max-evals=50", "--repeat=2",
         "--quiet", "--out=" + (folder / "run").string()});
    run({"check", "--update", "--baseline=" + (folder / "baseline.json").string(),
         (folder / "run").string()});
    return true;
  }();
  (void)made;
  return folder;
}

std::string prepared_file(const std::string& name) {
  return content(prepared() / name);
}

// Records without the command line and the processor, so that what is kept of them names no machine.
std::string of_no_machine(const std::string& records) {
  static const std::regex own("(\"(command|cpu)\":)\"[^\"]*\"");
  return std::regex_replace(records, own, "$1\"x\"");
}

std::string first_lines(const std::string& text, std::size_t count) {
  std::string out;
  for (const std::string& line : lines(text))
    if (count-- > 0)
      out += line + "\n";
    else
      break;
  return out;
}

// The first lines of a pair of raw files.
std::string raw_file(const std::string& name) {
  static const TemporaryFolder folder;
  static const bool made = [] {
    const Words words{"simulate", "--raw", "--scenario=vitko2024", "--quiet",
                      "--out=" + (folder / "raw").string()};
    return bench_in_process(words).exit_code == 0;
  }();
  if (!made) throw std::runtime_error("cannot prepare raw files");
  return first_lines(content(folder / ("raw/" + name)), 50);
}

std::string source_file(const std::string& name) {
  return content(source_dir() / "datasets" / name);
}

std::string out(const TemporaryFolder& folder, const std::string& name) {
  return (folder / "out").string() + "/" + name;
}

std::vector<Words> read_filter(const std::string& data, const std::string& truth,
                               const TemporaryFolder& folder) {
  Words words{"filter", "--data=" + folder.file("run.csv", data), "--quiet",
              "--out=" + out(folder, "filtered.csv"), "--overwrite"};
  if (!truth.empty()) words.push_back("--truth=" + folder.file("truth.csv", truth));
  return {words};
}

std::vector<Words> read_raw(const std::string& capture, const std::string& wheels,
                            const TemporaryFolder& folder) {
  fs::create_directories(folder / "raw");
  folder.file("raw/abs_1.csv", capture);
  folder.file("raw/odom_1.csv", wheels);
  return {{"import", "vitko2024", "--from=" + (folder / "raw").string(), "--out=" + out(folder, "set.json"),
           "--overwrite", "--quiet"}};
}

const std::string kOptiodomMetadata =
    "type,diff,,\nngear,43.7,,\nencRes,64,,\nLi,0.2,,\nDi,0.084,0.084,\nThi,,,\nN,1,,\nL,0.75,,\nimarkers,2,"
    "5,\n";
const std::string kOptiodomRun =
    "0,0,0,0,-0,12\n0.05,-1.5e-05,0.25,-0.000299,0,0\n0.100000000000001,0.002,0.5,0.001,127,-48\n";

std::vector<Words> read_optiodom(const std::string& metadata, const std::string& run,
                                 const TemporaryFolder& folder) {
  fs::create_directories(folder / "diff/square/0102");
  folder.file("diff/square/0102/0102_metadata.csv", metadata);
  folder.file("diff/square/0102/0102_run-01.csv", run);
  return {{"import", "optiodom", "--from=" + (folder / "diff/square/0102").string(),
           "--out=" + out(folder, "set.json"), "--overwrite", "--quiet"}};
}

const std::string kOwnMap = R"({"schema": "odobench-import", "schema_version": 1, "name": "mine",
 "robot": {"name": "r", "kinematics": "differential", "parameters": [{"name": "b", "nominal": 0.3}, {"name": "r_left", "nominal": 0.05}]},
 "time": {"column": "t_ms", "unit": "ms"},
 "reference": {"x": {"column": "x_mm", "unit": "mm"}, "y": {"column": "y_mm", "unit": "mm"}, "theta": {"column": "yaw_deg", "unit": "deg"}},
 "signals": {"wheel.left": {"column": "left", "unit": "count", "per_turn": 1000, "bits": 16, "sign": -1},
             "wheel.right": {"column": "right", "kind": "position", "unit": "count", "per_turn": 1000}},
 "trajectories": {"drive": {"trajectory": "bend", "repetition": 2}}})";
const std::string kOwnCsv =
    "t_ms,x_mm,y_mm,yaw_deg,left,right\n1760000000000.5,0,0,179.5,5,100\n1760000000050.5,12.5,0.25,-179,"
    "65530,"
    "112\n1760000000100.5,,,,65518,124\n1760000000150.5,37.5,1,-176.5,65506,136\n";

std::vector<Words> read_own_csv(const std::string& map, const std::string& csv,
                                const TemporaryFolder& folder) {
  const std::string file = folder.file("drive.csv", csv);
  return {{"import", "csv", "--from=" + file, "--map=" + folder.file("map.json", map),
           "--out=" + out(folder, "set.json"), "--overwrite", "--quiet"},
          {"import", "csv", "--from=" + file, "--propose"}};
}

// A run directory whose file `name` has these bytes.
std::string run_directory(const std::string& name, const std::string& bytes, const TemporaryFolder& folder) {
  if (!fs::exists(folder / "run")) fs::copy(prepared() / "run", folder / "run", fs::copy_options::recursive);
  folder.file("run/" + name, bytes);
  return (folder / "run").string();
}

const std::string kEndPoses = "drive;x [mm];y [mm];theta_deg\nrun_1;1.5;0.25;-3\n";

std::vector<Words> read_end_poses(const std::string& poses, const TemporaryFolder& folder) {
  std::string log = "t,left,right\n";
  for (int k = 0; k < 40; ++k)
    log += std::to_string(k) + "e-1," + std::to_string(k) + "," + std::to_string(2 * k) + "\n";
  const std::string map = R"({"schema": "odobench-import", "schema_version": 1, "name": "tape",
    "robot": {"name": "r", "kinematics": "differential"}, "poses": "poses.csv",
    "sources": {"w": {"files": "run_*.csv", "time": "t", "time_unit": "s"}},
    "signals": {"wheel_angle.left": {"field": "left", "unit": "rad"},
                "wheel_angle.right": {"field": "right", "unit": "rad"}}})";
  folder.file("poses.csv", poses);
  return {{"import", folder.file("run_1.csv", log), "--map=" + folder.file("map.json", map), "--quiet",
           "--overwrite", "--out=" + out(folder, "tape.json")}};
}

std::vector<Words> read_scenario(const std::string& bytes, const TemporaryFolder& folder) {
  const std::string file = folder.file("scenario.json", bytes);
  return {{"list", "scenarios", file},
          {"simulate", "--scenario=" + file, "--threads=1", "--quiet", "--overwrite",
           "--out=" + out(folder, "drive")}};
}

// A set of schema 2: counts that run over, a reference here and there, parameters that are one.
std::string robot_set() {
  return R"({"schema": "odobench-dataset", "schema_version": 2, "name": "mine",
 "robot": {"name": "r", "kinematics": "differential", "twist": "least_squares", "integration": "arc",
  "parameters": [{"name": "b", "nominal": 0.3}, {"name": "r_right", "unit": "m", "nominal": 0.05, "lower": 0.04, "upper": 0.06},
                 {"name": "r_left", "equals": "r_right"}]},
 "signals": [{"name": "wheel.right", "kind": "position", "unit": "count", "per_turn": 100, "bits": 8, "sign": -1},
             {"name": "wheel.left", "kind": "travel", "unit": "m", "radius": 0.05}],
 "trajectories": [{"name": "t"}],
 "known_parameters": [{"name": "truth", "values": {"b": 0.31, "r_right": 0.051}}],
 "recordings": [{"id": "t1", "trajectory": "t", "repetition": 1, "samples": 4, "columns": {
   "time_us": [0, 50000, 100000, 150000], "x": [0, null, 0.01, 0.03], "y": [0, null, 0.001, 0.002],
   "theta": [0.1, null, 0.2, 0.4], "wheel.right": [250, 254, 3, 1], "wheel.left": [0, 0.01, 0.02, 0.04]}}]}
)";
}
// Wheels of one's own, one of each sort.
std::string own_wheels_set() {
  return R"({"schema": "odobench-dataset", "schema_version": 2, "name": "own",
 "robot": {"name": "r", "kinematics": "wheels", "integration": "midpoint",
  "wheels": [{"x": 0.2, "y": 0, "drive": {"wheel.a": 0.5, "wheel.b": 0.5}, "steering": "steer", "offset": 0.01, "trail": 0.02},
             {"x": 0, "mount": 0.1, "radius": 0.05, "roller": 0.3, "drive": "wheel.b", "slides": true}, {"x": 0}],
  "parameters": [{"name": "r", "unit": "m", "nominal": 0.05, "sets": "wheels/0/radius"},
                 {"name": "w", "unit": "m", "nominal": 0.2, "lower": 0.1, "upper": 0.3, "sets": {"wheels/1/y": 1, "wheels/2/y": -1}},
                 {"name": "z", "unit": "rad", "nominal": 0, "sets": ["wheels/0/zero"]}]},
 "signals": [{"name": "wheel.a", "kind": "speed", "unit": "rpm"}, {"name": "wheel.b", "kind": "speed", "unit": "rad/s"},
             {"name": "steer", "kind": "angle", "unit": "deg"}],
 "trajectories": [{"name": "t"}],
 "recordings": [{"id": "t1", "trajectory": "t", "repetition": 1, "columns": {
   "time_us": [0, 50000, 100000], "x": [0, 0.01, 0.02], "y": [0, 0, 0.01], "theta": [0, 0.1, 0.2],
   "wheel.a": [10, 20, 30], "wheel.b": [1, 2, 3], "steer": [5, -5, 20]}}]}
)";
}

std::vector<Format> make_formats() {
  using Files = const TemporaryFolder&;
  using Bytes = const std::string&;
  using Commands = std::vector<Words>;
  return {
      {"set",
       [] {
         return std::vector<std::string>{prepared_file("set.json"), prepared_file("files.json")};
       },
       [](Bytes b, Files f) -> Commands {
         if (!fs::exists(f / "files_recordings"))
           fs::copy(prepared() / "files_recordings", f / "files_recordings", fs::copy_options::recursive);
         const std::string file = f.file("set.json", b);
         return {{"evaluate", "--data=" + file, "--out=" + out(f, "run"), "--overwrite"},
                 {"list", "data", file}};
       }},
      {"robots",
       [] {
         return std::vector<std::string>{robot_set(), own_wheels_set()};
       },
       [](Bytes b, Files f) -> Commands {
         const std::string file = f.file("set.json", b);
         return {{"evaluate", "--data=" + file, "--cost=segments", "--distance=0.01", "--mount",
                  "--out=" + out(f, "run"), "--overwrite"},
                 {"--data=" + file, "--solver=lm", "--max-evals=30", "--quiet"},
                 {"list", "data", file}};
       }},
      {"recording",
       [] { return std::vector<std::string>{encode_recording(tiny_dataset().recordings[0], 1)}; },
       [](Bytes b, Files f) -> Commands {
         Dataset d = tiny_dataset();
         d.recordings.resize(1);
         save_dataset(d, f / "set.json");
         std::string set = content(f / "set.json");
         const std::string good = sha256(encode_recording(d.recordings[0], 1));
         set.replace(set.find(good), good.size(), sha256(b));
         f.file("set.json", set);
         f.file("set_recordings/" + d.recordings[0].id + ".rec", b);
         return {{"evaluate", "--data=" + (f / "set.json").string()}};
       }},
      {"parameters",
       [] {
         std::string text;
         for (const RobotParameter& p : robot_4wis4wid().parameters)
           text += (text.empty() ? "{\"" : ", \"") + p.name + "\": " + std::to_string(p.nominal);
         return std::vector<std::string>{text + ", \"name\": \"mine\"}", "[" + text + "}]"};
       },
       [](Bytes b, Files f) -> Commands {
         return {{"evaluate", "--data=" + (prepared() / "set.json").string(),
                  "--parameters=" + f.file("p.json", b)}};
       }},
      {"capture", [] { return std::vector<std::string>{raw_file("abs_1.csv")}; },
       [](Bytes b, Files f) -> Commands { return read_raw(b, raw_file("odom_1.csv"), f); }},
      {"wheels", [] { return std::vector<std::string>{raw_file("odom_1.csv")}; },
       [](Bytes b, Files f) -> Commands { return read_raw(raw_file("abs_1.csv"), b, f); }},
      {"optiodom_metadata", [] { return std::vector<std::string>{kOptiodomMetadata}; },
       [](Bytes b, Files f) -> Commands { return read_optiodom(b, kOptiodomRun, f); }},
      {"optiodom_run", [] { return std::vector<std::string>{kOptiodomRun}; },
       [](Bytes b, Files f) -> Commands { return read_optiodom(kOptiodomMetadata, b, f); }},
      {"import_map", [] { return std::vector<std::string>{kOwnMap}; },
       [](Bytes b, Files f) -> Commands { return read_own_csv(b, kOwnCsv, f); }},
      {"own_csv", [] { return std::vector<std::string>{kOwnCsv}; },
       [](Bytes b, Files f) -> Commands { return read_own_csv(kOwnMap, b, f); }},
      {"filter", [] { return std::vector<std::string>{CircleRun().data()}; },
       [](Bytes b, Files f) -> Commands { return read_filter(b, "", f); }},
      {"truth", [] { return std::vector<std::string>{CircleRun().truth()}; },
       [](Bytes b, Files f) -> Commands { return read_filter(CircleRun().data(), b, f); }},
      {"windows", [] { return std::vector<std::string>{windows_json()}; },
       [](Bytes b, Files f) -> Commands {
         return {{"windows", f.file("w.json", b), "--solver=coordinate", "--quiet", "--threads=1"}};
       }},
      {"scenario",
       [] {
         return std::vector<std::string>{source_file("scenarios/exact.json"),
                                         source_file("scenarios/rich.json")};
       },
       read_scenario},
      {"dynamics", [] { return std::vector<std::string>{source_file("scenarios/filter_run.json")}; },
       read_scenario},
      {"sensors", [] { return std::vector<std::string>{source_file("sensors/heading_only.json")}; },
       [](Bytes b, Files f) -> Commands {
         return {{"fuse", "--data=" + (prepared() / "set.json").string(), "--sensors=" + f.file("s.json", b),
                  "--filter=ekf", "--threads=1"}};
       }},
      {"system",
       [] {
         return std::vector<std::string>{source_file("systems/constant_acceleration.json"),
                                         source_file("systems/turn3d.json")};
       },
       [](Bytes b, Files f) -> Commands {
         return {{"discretise", "--system=" + f.file("s.json", b), "--period=0.1"}};
       }},
      {"records", [] { return std::vector<std::string>{of_no_machine(prepared_file("run/runs.jsonl"))}; },
       [](Bytes b, Files f) -> Commands {
         const std::string file = f.file("runs.jsonl", b);
         return {{"report", file},
                 {"report", file, "--out=" + out(f, "r.html"), "--overwrite"},
                 {"compare", (prepared() / "run").string(), file}};
       }},
      {"tracks", [] { return std::vector<std::string>{prepared_file("run/tracks/tracks.json")}; },
       [](Bytes b, Files f) -> Commands {
         return {{"export", run_directory("tracks/tracks.json", b, f), "--tum", "--overwrite",
                  "--out=" + out(f, "tum")}};
       }},
      {"kept_parameters", [] { return std::vector<std::string>{prepared_file("run/parameters/lm.json")}; },
       [](Bytes b, Files f) -> Commands {
         const std::string run = run_directory("parameters/lm.json", b, f);
         return {{"export", run, "--to=ros2", "--row=lm"},
                 {"export", run, "--to=c", "--out=" + out(f, "p.h"), "--overwrite"},
                 {"evaluate", "--data=" + (prepared() / "set.json").string(),
                  "--parameters=" + run + "/parameters/lm.json"}};
       }},
      {"end_poses", [] { return std::vector<std::string>{kEndPoses}; },
       [](Bytes b, Files f) -> Commands { return read_end_poses(b, f); }},
      {"array", [] { return std::vector<std::string>{prepared_file("run/tracks/1.npy")}; },
       [](Bytes b, Files f) -> Commands {
         return {{"export", run_directory("tracks/1.npy", b, f), "--tum", "--overwrite",
                  "--out=" + out(f, "tum")}};
       }},
      {"baseline", [] { return std::vector<std::string>{prepared_file("baseline.json")}; },
       [](Bytes b, Files f) -> Commands {
         return {{"check", "--baseline=" + f.file("b.json", b), (prepared() / "run").string()}};
       }},
      {"configuration",
       [] {
         return std::vector<std::string>{
             "{\"solver\": [\"lm\", \"pso[swarm=20]\"], \"repeat\": 2, \"seed\": 7}",
             "[run]\nsolver = [lm, \"ga[population=20]\"]\nrepeat = 2 # twice\n"};
       },
       [](Bytes b, Files f) -> Commands {
         return {{"--config=" + f.file("c.json", b), "--problem=sphere", "--max-evals=40", "--time-limit=1",
                  "--threads=1", "--quiet"}};
       }},
      {"options",  // a line each: solvers, the one that polishes, starting points, target
       [] {
         return std::vector<std::string>{"lm[gradient_tolerance=1e-8],pso[swarm=20]\nlm\nrandom\n1e-6",
                                         "ga[population=20],cmaes[sigma=0.2]\nnlopt:bobyqa\nnominal\n0"};
       },
       [](Bytes b, Files) -> Commands {
         std::vector<std::string> values = lines(b.substr(0, b.find('\0')));
         values.resize(4);
         return {{"--problem=sphere", "--max-evals=40", "--time-limit=1", "--threads=1", "--quiet",
                  "--solver=" + values[0], "--polish=" + values[1], "--start=" + values[2],
                  "--target=" + values[3]}};
       }},
  };
}

// The first line with nan or inf as a number, not as a part of a word.
std::string not_finite(const std::string& text) {
  static const std::regex number("(^|[^A-Za-z_])[-+]?(nan|inf)($|[^A-Za-z_])",
                                 std::regex::icase | std::regex::optimize);
  for (const std::string& line : lines(text))
    if (line.size() < 10000 && std::regex_search(line, number)) return line;
  return "";
}

// A name that has it is shown with it; null is how records store what is not finite.
bool speaks_of_infinity(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text.find("nan") != std::string::npos || text.find("inf") != std::string::npos ||
         text.find("null") != std::string::npos;
}

}  // namespace

bool unprintable(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint c = code_point_at(text, at);
    const bool control =
        (c.value < 0x20 && c.value != '\n' && c.value != '\r') || (c.value >= 0x7F && c.value < 0xA0);
    if (!c.valid || control || (c.value >= 0x202A && c.value <= 0x202E)) return true;
    at += c.bytes;
  }
  return false;
}

const std::vector<Format>& formats() {
  static const std::vector<Format> list = [] {
    std::vector<Format> all = make_formats();
    for (Format& format : log_formats_read()) all.push_back(std::move(format));
    return all;
  }();
  return list;
}

std::vector<std::string> format_names() {
  std::vector<std::string> list;
  for (const Format& format : formats()) list.push_back(format.name);
  return list;
}

const Format& format_called(const std::string& name) {
  for (const Format& format : formats())
    if (format.name == name) return format;
  throw std::invalid_argument("no format is called " + name);
}

std::string complaint_about(const ProcessResult& result, const TemporaryFolder& folder,
                            const std::string& input, bool binary) {
  if (result.signal != 0) return "ended by signal " + std::to_string(result.signal);
  if (result.exit_code < 0 || result.exit_code > 3) return "exit code " + std::to_string(result.exit_code);
  std::size_t said = 0;
  for (const std::string& line : lines(result.err)) said += line.rfind("bench: error: ", 0) == 0 ? 1 : 0;
  if (said != (result.exit_code >= 2 ? 1u : 0u)) return std::to_string(said) + " lines of error";
  if (unprintable(result.out) || unprintable(result.err)) return "control characters or invalid UTF-8";
  if (result.err.size() > 20000) return "messages of " + std::to_string(result.err.size()) + " bytes";
  if (const std::string line = not_finite(result.out);
      result.exit_code < 2 && !line.empty() && !binary && !speaks_of_infinity(input))
    return "nan or inf among the results: " + line;
  for (const std::string& name : files_below(folder / "out"))
    if (name.find(".tmp-") != std::string::npos) return "left " + name;
  if (result.exit_code >= 2 && fs::exists(folder / "out")) return "left an output after an error";
  return "";
}

}  // namespace odobench::testing
