#include "bench/studies/entropy/window_study.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "base/error.hpp"
#include "base/names.hpp"
#include "base/sha256.hpp"
#include "base/text.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/cell_recorder.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/records.hpp"
#include "datasets/entropy/entropy_window_file.hpp"
#include "problems/entropy/direct_form.hpp"
#include "problems/entropy/window_problem.hpp"
#include "reports/kinds/entropy/window_tables.hpp"
#include "solvers/lattice/ternary_search.hpp"

namespace odobench {
namespace {

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

LoadedWindow loaded_window(const EntropyWindow& window, const Stop& stop) {
  LoadedWindow w{window, {Problem(WindowProblem(window)), nullptr, std::nullopt, "", "", ""}, "", ""};
  const BlockQuadratic& cost = *w.loaded.problem.block_quadratic();
  const auto stopped = [stop] { return stop.requested(); };  // long windows take their time
  EntropyState state;
  w.zero = value_at(window, w.loaded.problem.start(), state);
  w.exact = optimum(window, cost, *ternary_branch_and_bound(cost.blocks, stopped));
  w.relaxed = optimum(window, cost, *box_relaxation(cost.blocks));
  return w;
}

LoadedWindow load(const EntropyWindow& window, const std::string& file, const Stop& stop) {
  try {
    return loaded_window(window, stop);
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
  record.measures.put({"samples", static_cast<double>(w.window.constants.samples), ""});
  if (result.usable()) add_measures(w, result.x, record);
  return record;
}

CellList plan_cells(const CellPlan& plan, const Catalogue& catalogue, std::vector<std::string>& notes) {
  CellList cells(catalogue);
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

CellPlan make_plan(const WindowStudy& study, const Catalogue& catalogue, std::vector<std::string>& notes) {
  CellPlan plan;
  plan.solvers = resolve_solvers(
      catalogue, study.solvers.empty() ? std::vector<std::string>{"coordinate,exact,relaxed"} : study.solvers,
      notes);
  plan.repeat = study.repeat;
  plan.base_seed = study.seed;
  plan.problem = kWindowProblem;
  return plan;
}

// All runs of one window, numbered from `first`.
void run_window(const WindowStudy& study, const LoadedWindow& window, CellPlan plan,
                const Catalogue& catalogue, const RunContext& context, std::size_t first, RunFolder& folder,
                Watcher& watcher, const Stop& stop, std::vector<RunRecord>& records) {
  std::vector<std::string> said;  // of the plan for all windows
  plan.dataset = window.dataset;
  const CellList cells = plan_cells(plan, catalogue, said);
  const auto record = [&](const RunCell& cell, const Result& result, const std::string& time_utc) {
    return window_record(
        window, result,
        run_record(window.loaded, cell, plan.base_seed, study.budget, result, context, time_utc));
  };
  CellRecorder recorder(cells, record, folder, watcher, first);
  run_cells({window.loaded.problem}, cells, study.budget, context.threads, stop, recorder);
  recorder.move_to(records);
}

}  // namespace

WindowRuns run_on_windows(const WindowStudy& study, const Catalogue& catalogue, RunFolder& folder,
                          Watcher& watcher, const Stop& stop) {
  std::vector<std::string> notes;
  const CellPlan plan = make_plan(study, catalogue, notes);
  const std::vector<EntropyWindow> windows = chosen(load_entropy_windows(study.file), study.only);
  require_finite(windows, study.file);
  const std::string stem = std::filesystem::path(study.file).stem().string();
  const std::string sha256 = sha256_of_file(study.file);
  const RunContext context = run_context(thread_count(study.threads), kernel_in_force(study.kernel));
  const CellList of_each = plan_cells(plan, catalogue, notes);
  const std::size_t per_window = of_each.size();
  if (windows.size() > kMostRuns / per_window)
    throw std::invalid_argument(
        fmt::format("{} windows with {} runs each; expected at most {} runs, see --only", windows.size(),
                    per_window, kMostRuns));
  folder.require_free();
  watcher.results_begin();
  folder.open();
  for (const std::string& text : notes) watcher.note(text);

  WindowRuns runs;
  runs.planned = windows.size() * per_window;
  watcher.runs_begin(runs.planned, [&](std::size_t i) {
    return windows[i / per_window].id + " " + of_each[i % per_window].label();
  });
  for (std::size_t i = 0; i < windows.size() && !stop.requested(); ++i) {
    LoadedWindow window = load(windows[i], study.file, stop);
    if (stop.requested()) break;  // what results are measured against is not known
    window.dataset = stem + "/" + windows[i].id;
    window.sha256 = sha256;
    run_window(study, window, plan, catalogue, context, i * per_window, folder, watcher, stop, runs.records);
  }
  watcher.runs_end();
  runs.interrupted = stop.requested();
  if (runs.records.empty()) throw Interruption();
  return runs;
}

}  // namespace odobench
