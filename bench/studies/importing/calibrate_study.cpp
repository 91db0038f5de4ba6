#include "bench/studies/importing/calibrate_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/files.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/robots.hpp"
#include "bench/studies/calibration/solver_study.hpp"
#include "bench/studies/exporting/robot_export.hpp"
#include "bench/studies/importing/log_proposal.hpp"
#include "bench/studies/importing/log_study.hpp"
#include "bench/studies/planning/next_steps.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/report_study.hpp"
#include "bench/studies/run_folder.hpp"
#include "bench/studies/trust/trust_study.hpp"
#include "datasets/native/sensor_files.hpp"
#include "reports/figures/document.hpp"
#include "reports/kinds/calibration/calibration_tables.hpp"
#include "reports/page/report_document.hpp"

namespace odobench {
namespace {
namespace fs = std::filesystem;

// The map that the logs are read by, as text.
std::string find_map(const CalibrateStudy& study, Watcher& watcher, const Stop& stop) {
  if (!study.map.empty()) return read_file(study.map);
  const LogProposal proposal = propose_log_map(
      study.logs, study.options, stop, study.answers.robot.empty() ? "" : robot_class(study.answers.robot));
  for (const std::string& reason : proposal.reasons) watcher.note(reason);
  if (!proposal.complete)
    throw std::invalid_argument(
        "no map could be made of these logs alone (see above): `bench import LOG... --propose > map.json` "
        "begins one, --map=map.json takes it");
  return fill_map(proposal.map, study.answers);
}

// Of the runs with trust in their records; an interruption leaves the rest without.
bool find_next_steps(const std::vector<LoadedProblem>& loaded, const std::string& command, const Stop& stop,
                     std::vector<RunRecord>& records) {
  bool changed = false;
  try {
    for (const LoadedProblem& one : loaded)
      for (RunRecord& r : records)
        if (r.kind == "run" && r.trust && r.problem == one.name()) {
          describe_next_steps(one, command, 0, stop, r);
          changed = true;
        }
  } catch (const Interruption&) {  // what is in the records stays
  }
  return changed;
}

SolverRuns run_lm(const CalibrateStudy& study, const fs::path& set, const Catalogue& catalogue,
                  Watcher& watcher, const Stop& stop) {
  RunFolder folder(study.out / "results", study.overwrite);
  folder.require_free();
  SolverStudy solver;
  solver.solvers = {"lm"};
  solver.data = set.string();
  solver.accept = study.accept;
  solver.calibration = study.calibration;
  TrustChoice choice;
  choice.validation = study.validation;
  TrustStudy trust(choice, solver, catalogue, folder, watcher, stop);
  SolverStudy judged = trust.with(solver);
  const std::string command = fmt::format("--data={}", set.string());
  judged.judge = [&, validate = judged.judge](const std::vector<LoadedProblem>& loaded,
                                              std::vector<RunRecord>& records) {
    const bool validated = validate(loaded, records);
    return find_next_steps(loaded, command, stop, records) || validated;
  };
  SolverRuns runs = run_solvers(judged, catalogue, folder, watcher, stop);
  folder.save(comparison_tables(runs.records, notes_of_best(runs.records)));
  return runs;
}

// The thesis' robot begins its drives at (0, 0); a room's frame lies anywhere. Cameras move along.
void begin_at_origin(ImportedLogs& imported) {
  if (imported.dataset.robot.kinematics != "4wis4wid") return;
  constexpr double kThere = 1e-9;  // m
  double farthest = 0;
  for (Recording& r : imported.dataset.recordings) {
    if (r.reference.x.empty() || (!r.reference.sample.empty() && r.reference.sample.front() != 0)) continue;
    const double x = r.reference.x.front(), y = r.reference.y.front();
    farthest = std::max(farthest, std::hypot(x, y));
    for (double& v : r.reference.x) v -= x;
    for (double& v : r.reference.y) v -= y;
    if (!imported.sensors.contains(r.id)) continue;
    for (SensorRows& rows : imported.sensors.at(r.id)) {
      if (rows.name != "camera") continue;
      for (double& v : rows.values[0]) v -= x;
      for (double& v : rows.values[1]) v -= y;
    }
  }
  if (farthest > kThere)
    imported.dataset.notes.push_back(
        fmt::format("every drive moved to begin at x = y = 0, by up to {:.3g} m", farthest));
}

// What gyro and camera measured, beside the set, and the file that names them for `bench fuse`.
void add_sensors(const ImportedLogs& imported, const fs::path& set, FileTransaction& files, Watcher& watcher,
                 Calibrated& out) {
  std::vector<std::string> ids;
  for (const Recording& r : imported.dataset.recordings) ids.push_back(r.id);
  for (const std::string& remark : add_sensor_files(imported.sensors, ids, set, files)) watcher.note(remark);
  const fs::path sensors = sensors_file_of(set);
  const std::vector<fs::path> targets = files.targets();
  if (std::find(targets.begin(), targets.end(), sensors) == targets.end()) return;
  out.files.push_back(sensors);
  // A filter that is given its own reference tells nothing.
  if (imported.dataset.robot.kinematics == "4wis4wid" &&
      imported.dataset.reference != ReferenceKind::Headings)
    out.sensors = sensors;
}

// The controller's YAML of a result, where there is one; the parameters stand in results/parameters, too.
void write_controller(const CalibrateStudy& study, Calibrated& out, Existing existing, Watcher& watcher) {
  if (!fs::exists(out.results / "parameters/lm.json")) return;
  ExportedRobot exported;
  fs::path file = study.out / "ros2.yaml";
  try {
    exported = export_robot({out.results, "ros2", "lm", "", false});
  } catch (const std::invalid_argument&) {  // no controller knows such a robot
    exported = export_robot({out.results, "yaml", "lm", "", false});
    file = study.out / "robot.yaml";
  }
  for (const std::string& warning : exported.warnings) watcher.note(warning);
  write_file(file, exported.text, existing);
  out.files.push_back(file);
}

}  // namespace

Calibrated calibrate_logs(const CalibrateStudy& study, const Catalogue& catalogue, Watcher& watcher,
                          const Stop& stop) {
  const Existing existing = existing_files(study.overwrite);
  Calibrated out;
  fs::path set = study.out / "set.json";
  if (study.logs.size() == 1 && is_dataset(study.logs.front())) {
    set = study.logs.front();
  } else {
    for (const char* name : {"map.json", "set.json", "report.html", "ros2.yaml"})
      require_writable(study.out / name, existing, "--out");
    const std::string map = find_map(study, watcher, stop);
    ImportedLogs imported =
        import_logs({study.logs, map, study.out / "map.json", study.options}, watcher, stop);
    begin_at_origin(imported);
    for (const std::string& line : imported.report) watcher.note(line);
    for (const std::string& line : imported.dataset.notes) watcher.note(line);
    watcher.results_begin();
    FileTransaction files(existing);
    files.add(study.out / "map.json", map);
    add_dataset(imported.dataset, set, files, false, stop);
    out.files = {study.out / "map.json", set};
    add_sensors(imported, set, files, watcher, out);
    files.commit();
  }
  SolverRuns runs = run_lm(study, set, catalogue, watcher, stop);
  out.results = study.out / "results";
  out.set = set;
  const fs::path page = study.out / "report.html";
  write_file(page, render_html(make_report(report_input({out.results.string()}, runs.records, ""))),
             existing);
  out.files.push_back(out.results);
  out.files.push_back(page);
  write_controller(study, out, existing, watcher);
  out.records = std::move(runs.records);
  return out;
}

}  // namespace odobench
