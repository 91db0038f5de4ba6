#include "bench/studies/importing/calibrate_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/files.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/calibration/solver_study.hpp"
#include "bench/studies/exporting/robot_export.hpp"
#include "bench/studies/importing/log_proposal.hpp"
#include "bench/studies/importing/log_study.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/report_study.hpp"
#include "bench/studies/run_folder.hpp"
#include "bench/studies/trust/trust_study.hpp"
#include "reports/figures/document.hpp"
#include "reports/kinds/calibration/calibration_tables.hpp"
#include "reports/page/report_document.hpp"

namespace odobench {
namespace {
namespace fs = std::filesystem;

// The map that the logs are read by, as text.
std::string find_map(const CalibrateStudy& study, bool& drifts, Watcher& watcher, const Stop& stop) {
  if (!study.map.empty()) return read_file(study.map);
  const LogProposal proposal = propose_log_map(study.logs, study.options, stop);
  for (const std::string& reason : proposal.reasons) watcher.note(reason);
  drifts = proposal.drifts;
  if (!proposal.complete)
    throw std::invalid_argument(
        "no map could be made of these logs alone (see above): `bench import LOG... --propose > map.json` "
        "begins one, --map=map.json takes it");
  return fill_map(proposal.map, study.answers);
}

SolverRuns run_lm(const CalibrateStudy& study, const fs::path& set, bool drifts, const Catalogue& catalogue,
                  Watcher& watcher, const Stop& stop) {
  RunFolder folder(study.out / "results", study.overwrite);
  folder.require_free();
  SolverStudy solver;
  solver.solvers = {"lm"};
  solver.data = set.string();
  solver.accept = study.accept;
  solver.calibration = study.calibration;
  if (drifts && !solver.calibration.cost) {
    solver.calibration.cost = CostKind::Segments;
    watcher.note(
        fmt::format("the reference drifts: --cost=segments, of {:g} m", solver.calibration.distance));
  }
  TrustChoice choice;
  choice.validation = study.validation;
  TrustStudy trust(choice, solver, catalogue, folder, watcher, stop);
  SolverRuns runs = run_solvers(trust.with(solver), catalogue, folder, watcher, stop);
  folder.save(comparison_tables(runs.records, notes_of_best(runs.records)));
  return runs;
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
  bool drifts = false;
  if (study.logs.size() == 1 && is_dataset(study.logs.front())) {
    set = study.logs.front();
  } else {
    for (const char* name : {"map.json", "set.json", "report.html", "ros2.yaml"})
      require_writable(study.out / name, existing, "--out");
    const std::string map = find_map(study, drifts, watcher, stop);
    ImportedLogs imported =
        import_logs({study.logs, map, study.out / "map.json", study.options}, watcher, stop);
    for (const std::string& line : imported.report) watcher.note(line);
    for (const std::string& line : imported.dataset.notes) watcher.note(line);
    watcher.results_begin();
    FileTransaction files(existing);
    files.add(study.out / "map.json", map);
    add_dataset(imported.dataset, set, files, false, stop);
    files.commit();
    out.files = {study.out / "map.json", set};
  }
  SolverRuns runs = run_lm(study, set, drifts, catalogue, watcher, stop);
  out.results = study.out / "results";
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
