#include "bench/verbs/windows.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>

#include "base/error.hpp"
#include "base/names.hpp"
#include "base/sha256.hpp"
#include "base/stop.hpp"
#include "base/text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/studies/cell_recorder.hpp"
#include "bench/studies/cells.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/records.hpp"
#include "bench/verbs/common_options.hpp"
#include "datasets/entropy/entropy_window_file.hpp"
#include "problems/entropy/direct_form.hpp"
#include "problems/entropy/window_problem.hpp"
#include "reports/kinds/entropy/window_tables.hpp"
#include "solvers/lattice/ternary_search.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace {

constexpr const char* kWindowsExamples = R"(Examples:
  bench windows windows.json --solver=coordinate,exact,relaxed,lm,ip,ga,pso,nlopt:bobyqa
  bench windows windows.json --only=csharp --format=json
  bench windows windows.json --solver=exact,pso --repeat=5 --out=results)";

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

void add_options(CLI::App& app, WindowsOptions& o) {
  app.add_option("file", o.file, "windows, JSON of the format entropy-window-1")->required();
  app.add_option("--solver", o.solvers,
                 "solvers, e.g. exact,pso[swarm=60]; 'all' for every one; may be given again "
                 "[coordinate,exact,relaxed]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--only", o.only, "ids or groups of windows [all]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  add_count(app, "--repeat", o.repeat, 1, 100000, "runs of every solver that draws random numbers [1]");
  add_seed(app, o.seed, "base of all seeds [1]");
  add_threads(app, o.threads);
  add_kernel(app, o.kernel, kNamedOnly);
  add_budget(app, o.budget);
  add_run_folder(app, o.out, o.overwrite);
  app.add_option("--format", o.format, "of the tables on standard output [console]")
      ->type_name("console|md|csv|json|latex");
  app.add_flag("--quiet", o.quiet, "no progress and no remarks on standard error, only warnings and errors");
  app.footer(kWindowsExamples);
}

// A window with what its results are measured against.
struct LoadedWindow {
  EntropyWindow window;
  LoadedProblem loaded;
  std::string dataset, sha256;              // name and check sum of the file
  double zero = 0, exact = 0, relaxed = 0;  // H
};

double value_at(const EntropyWindow& window, const Vector& t, EntropyState& state) {
  const Vector values = increments(window.constants, t);
  state = closed_form(window, values);
  return hamiltonian(window, values, state);
}

// H at the solution of a search, worked out like H of every result: what is the same t has the same H to the
// last bit.
double optimum(const EntropyWindow& window, const BlockQuadratic& cost, BlockSearch& search) {
  const Vector g = cost.stacked_g();
  Vector x(g.size());
  const auto size = static_cast<std::size_t>(g.size());
  search.minimise({g.data(), size}, {x.data(), size});
  EntropyState state;
  return value_at(window, cost.unstack(x), state);
}

// Sizes, periods and deviations that are numbers each may overflow together.
void require_finite(const std::vector<EntropyWindow>& windows, const std::string& file) {
  for (const EntropyWindow& w : windows) {
    EntropyState state;
    const double h = value_at(w, Problem(WindowProblem(w)).start(), state);
    if (!std::isfinite(h))
      throw DataError(
          fmt::format("{}: window '{}' overflows: found H = {:g}, expected values, period and "
                      "standard deviations of a size that a robot meets",
                      file, w.id, h));
  }
}

LoadedWindow loaded_window(const EntropyWindow& window) {
  LoadedWindow w{window, {Problem(WindowProblem(window)), nullptr, std::nullopt, "", "", ""}, "", ""};
  const BlockQuadratic& cost = *w.loaded.problem.block_quadratic();
  EntropyState state;
  w.zero = value_at(window, w.loaded.problem.start(), state);
  const auto stop = [] { return InterruptGuard::flag().load(); };  // long windows take their time
  w.exact = optimum(window, cost, *ternary_branch_and_bound(cost.blocks, stop));
  w.relaxed = optimum(window, cost, *box_relaxation(cost.blocks));
  return w;
}

LoadedWindow load(const EntropyWindow& window, const std::string& file) {
  try {
    return loaded_window(window);
  } catch (const std::invalid_argument& e) {  // of the quadratic form, which knows no file
    throw DataError(fmt::format("{}: window '{}': {}", file, shown(window.id), e.what()));
  }
}

void add_measures(const LoadedWindow& w, const Vector& t, RunRecord& record) {
  EntropyState state;
  record.measures.put({"hamiltonian", value_at(w.window, t, state), ""});
  record.measures.put({"r1", state.r1, "m"});
  record.measures.put({"sx1", state.sx1, "m"});
  record.measures.put({"sy1", state.sy1, "m"});
  record.measures.put({"ax12", state.ax12, "m/s^2"});
  record.measures.put({"ay12", state.ay12, "m/s^2"});
  record.measures.put({"hamiltonian_rounded", value_at(w.window, t.array().round().matrix(), state), ""});
  record.measures.put({"hamiltonian_zero", w.zero, ""});
  record.measures.put({"hamiltonian_exact", w.exact, ""});
  record.measures.put({"hamiltonian_relaxed", w.relaxed, ""});
}

// `record`: of the run, without what it says of the window.
RunRecord window_record(const LoadedWindow& w, const Result& result, RunRecord record) {
  record.dataset = w.dataset;
  record.dataset_sha256 = w.sha256;
  record.group = w.window.group;
  record.statistics["samples"] = w.window.constants.samples;
  if (result.usable()) add_statistics(w, result.x, record);
  return record;
}

CellList plan_cells(const CellPlan& plan, std::vector<std::string>& notes) {
  CellList cells;
  cells.add(plan, 0, notes);
  return cells;
}

std::vector<EntropyWindow> chosen(std::vector<EntropyWindow> windows, const std::vector<std::string>& only) {
  if (only.empty()) return windows;
  std::set<std::string> known;
  for (const EntropyWindow& w : windows) {
    known.insert(w.id);
    if (!w.group.empty()) known.insert(w.group);
  }
  std::set<std::string> wanted;
  for (const std::string& name : comma_items(only)) {
    if (known.count(name) == 0) {
      throw std::invalid_argument(fmt::format("--only={}: no window or group of the file{}", name,
                                              did_you_mean(name, {known.begin(), known.end()})));
    }
    wanted.insert(name);
  }
  std::vector<EntropyWindow> some;
  for (EntropyWindow& w : windows)
    if (wanted.count(w.id) != 0 || wanted.count(w.group) != 0) some.push_back(std::move(w));
  return some;
}

ExitCode outcome(const std::vector<RunRecord>& records, std::size_t planned, bool interrupted,
                 const std::string& out) {
  std::size_t stopped = 0;
  bool any = false;
  for (const RunRecord& r : records) {
    if (r.termination == to_string(Termination::Interrupted)) ++stopped;
    any = any || (r.kind == "run" && r.cost);
  }
  if (interrupted && (stopped > 0 || records.size() < planned)) {
    note(fmt::format("interrupted: {} of {} runs complete{}", records.size() - stopped, planned,
                     out.empty() ? "" : "; records are in " + out));
    return ExitCode::Interrupted;
  }
  if (any) return ExitCode::Success;
  warn("not one solver gave a result");
  return ExitCode::CheckFailed;
}

ExitCode windows_command(const WindowsOptions& options) {
  const Format format = parse_format(options.format);
  std::vector<std::string> notes;
  CellPlan plan;
  plan.solvers = resolve_solvers(
      options.solvers.empty() ? std::vector<std::string>{"coordinate,exact,relaxed"} : options.solvers,
      notes);
  plan.repeat = options.repeat;
  plan.base_seed = options.seed;
  plan.problem = kWindowProblem;
  const std::vector<EntropyWindow> windows = chosen(load_entropy_windows(options.file), options.only);
  require_finite(windows, options.file);
  const std::string stem = std::filesystem::path(options.file).stem().string();
  const std::string sha256 = sha256_of_file(options.file);
  const int threads = thread_count(options.threads);
  const RunContext context = run_context(threads, kernel_in_force(options.kernel));
  const CellList of_each = plan_cells(plan, notes);
  const std::size_t per_window = of_each.size();
  if (windows.size() > kMostRuns / per_window)
    throw std::invalid_argument(
        fmt::format("{} windows with {} runs each; expected at most {} runs, see --only", windows.size(),
                    per_window, kMostRuns));
  InterruptGuard::remember();
  std::unique_ptr<RecordFile> file;
  if (!options.out.empty()) {
    require_no_records(options.out, options.overwrite);
    file = std::make_unique<RecordFile>(options.out, options.overwrite);
  }
  if (!options.quiet)
    for (const std::string& text : notes) note(text);

  std::vector<std::string> ignored;
  TerminalWatcher watcher(options.quiet);
  const auto label = [&](std::size_t i) {
    return windows[i / per_window].id + " " + of_each[i % per_window].label();
  };
  watcher.runs_begin(windows.size() * per_window, label);
  std::vector<RunRecord> records;
  for (std::size_t i = 0; i < windows.size() && !InterruptGuard::flag().load(); ++i) {
    LoadedWindow window = load(windows[i], options.file);
    if (InterruptGuard::flag().load()) break;  // what results are measured against is not known
    plan.dataset = window.dataset = stem + "/" + windows[i].id;
    window.sha256 = sha256;
    const CellList cells = plan_cells(plan, ignored);
    const auto make = [&](const RunCell& cell, const Result& result, const std::string& time_utc) {
      return window_record(
          window, result,
          run_record(window.loaded, cell, plan.base_seed, options.budget, result, context, time_utc));
    };
    CellRecorder recorder(cells, make, file.get(), watcher, i * per_window);
    run_cells({window.loaded.problem}, cells, options.budget, threads, InterruptGuard::flag(), recorder);
    recorder.move_to(records);
  }
  watcher.runs_end();
  if (records.empty()) throw Interruption();
  const bool machine = format == Format::Json || format == Format::Csv;
  if (file) save_tables(window_tables(records, false), options.out);
  print_tables(window_tables(records, machine), format);
  return outcome(records, windows.size() * per_window, InterruptGuard::flag().load(), options.out);
}

}  // namespace

VerbAction add_windows(CLI::App& app) {
  return verb_action<WindowsOptions>(app, add_options, windows_command);
}

}  // namespace odobench
