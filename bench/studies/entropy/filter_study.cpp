#include "bench/studies/entropy/filter_study.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/entropy/entropy_search.hpp"
#include "bench/studies/entropy/entropy_signals.hpp"
#include "bench/studies/entropy/entropy_statistics.hpp"
#include "bench/studies/entropy/filter_input.hpp"
#include "bench/studies/entropy/linear_comparison.hpp"
#include "bench/studies/entropy/unit_watch.hpp"
#include "reports/kinds/entropy/entropy_tables.hpp"
#include "solvers/lattice/ternary_search.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// Everything that happens to a window.
class FilterRun {
 public:
  FilterRun(const EntropyOptions& options, const Catalogue& catalogue, const FilterSetup& setup,
            InstructionSet kernel, const FilterInputs& data, const TextSink& standard_output,
            const Stop& stop)
      : catalogue_(catalogue),
        setup_(setup),
        file_name_(data.file()),
        profile_(setup.constants),
        method_(make_filter_method(options.solver, catalogue, profile_, options.budget, options.seed, kernel,
                                   stop)),
        filter_(profile_, method_.search.get()),
        converter_(setup),
        noise_(setup),
        units_(setup.constants),
        signals_(!options.truth.empty()),
        rows_(static_cast<std::size_t>(setup.constants.samples)),
        truths_(rows_count()),
        times_(rows_count()),
        lines_(rows_count()),
        with_truth_(!options.truth.empty()),
        stop_(stop) {
    if (!options.out.empty())
      file_.emplace(options.out, existing_files(options.overwrite), standard_output, setup.constants.samples,
                    data.has_time(), setup.rotation_sign);
    if (options.compare_kalman) linear_.emplace(profile_);
    if (!options.gap) return;
    exact_search_ = ternary_exact(
        profile_.blocks(), [stop] { return stop.requested(); }, kernel);
    relaxed_search_ = box_relaxation(profile_.blocks());
    exact_.emplace(profile_, exact_search_.get());
    relaxed_.emplace(profile_, relaxed_search_.get());
  }

  // False when an interruption came in the middle of the window.
  bool push(const FilterInput& input) {
    ++count_;
    const ConvertedRow& row = converter_.convert(input.row);
    rows_.push(row);
    units_.add(row);
    times_.push(input.row.time_s);
    lines_.push(input.row.line);
    if (with_truth_) truths_.push(converter_.convert(input.truth));
    if (method_.registry != nullptr) method_.registry->observe(row.sample);
    if (linear_) linear_->entropy().begin();
    const FilterOutput* output = filter_.push(row.sample);
    if (linear_) linear_->entropy().end();
    if (linear_) linear_->push(row.sample);
    const FilterOutput* exact = exact_ ? exact_->push(row.sample) : nullptr;
    const FilterOutput* relaxed = relaxed_ ? relaxed_->push(row.sample) : nullptr;
    if (stop_.requested()) return false;
    if (output == nullptr) return true;
    require_finite(*output);
    const auto value = [](const FilterOutput* o) {
      return o == nullptr ? std::nullopt : std::optional<double>(o->hamiltonian);
    };
    method_meter_.add(*output, value(exact), value(relaxed));
    signals_.add(rows_[0], *output, with_truth_ ? &truths_[0] : nullptr, with_truth_ ? &truths_[1] : nullptr);
    if (linear_) compared_ = linear_->estimates();
    if (with_truth_) noise_.add(rows_[0], truths_[0], truths_[1], *output, linear_ ? &compared_ : nullptr);
    if (file_) file_->add(*output, times_[0]);
    return true;
  }

  RunRecord record(double seconds) const;
  std::int64_t windows() const { return method_meter_.windows(); }
  std::vector<std::string> suspicions() const { return units_.remarks(); }
  bool slow() const { return method_.registry != nullptr; }
  void commit() {
    if (file_) file_->commit();
  }

 private:
  // Sizes, periods and deviations that are numbers each may overflow together.
  void require_finite(const FilterOutput& o) const {
    double sum = o.hamiltonian + o.zero.h0 + o.state.ax12 + o.state.ay12 + o.state.r1 + o.state.sx1 +
                 o.state.sy1 + o.first.rotation;
    for (std::size_t w = 0; w < 4; ++w) sum += std::hypot(o.first.x[w], o.first.y[w]);
    if (std::isfinite(sum)) return;
    throw DataError(
        fmt::format("{}:{}: the window of {} rows from here on overflows: found H = {:g}, expected "
                    "values, period and standard deviations of a size that a robot meets",
                    file_name_, lines_[0], setup_.constants.samples, o.hamiltonian));
  }

  std::size_t rows_count() const { return static_cast<std::size_t>(setup_.constants.samples); }

  const Catalogue& catalogue_;
  FilterSetup setup_;
  const std::string file_name_;
  ProfileForm profile_;
  FilterMethod method_;
  SlidingFilter filter_;
  SampleConverter converter_;
  NoiseMeter noise_;
  UnitWatch units_;
  SignalMeter signals_;
  MethodMeter method_meter_;
  LastOf<ConvertedRow> rows_;
  LastOf<TrueSample> truths_;
  LastOf<double> times_;
  LastOf<std::size_t> lines_;
  const bool with_truth_;
  const Stop stop_;
  std::int64_t count_ = 0;
  std::optional<FilterOutputFile> file_;
  std::unique_ptr<BlockSearch> exact_search_, relaxed_search_;
  std::optional<SlidingFilter> exact_, relaxed_;
  std::optional<LinearComparison> linear_;
  LinearEstimates compared_;
};

RunRecord FilterRun::record(double seconds) const {
  RunRecord r;
  r.problem = kFilterProblem;
  r.label = method_.spec.text();
  r.kind = "run";
  r.solver = method_.spec.name;
  if (r.solver != "zero") catalogue_.solver(r.solver).make(method_.spec.options, &r.options);
  r.start = "nominal";
  r.cost = -method_meter_.hamiltonian_mean();
  r.evaluations = r.cost_evaluations = method_meter_.evaluations();
  r.iterations = method_meter_.iterations();
  r.seconds = seconds;
  method_meter_.report(r.measures);
  if (with_truth_) noise_.report(r.measures);
  if (linear_) linear_->report(r.measures);
  signals_.report(r.series);
  method_meter_.histogram().report(r.series);
  r.measures.put({"rows", static_cast<double>(count_), ""});
  r.measures.put(
      {"windows_per_second", static_cast<double>(windows()) / seconds, "1/s", Better::Higher, "", true});
  return r;
}

// Constants whose quadratic form overflows are refused in the words of the options.
ProfileForm profile_of(const EntropyConstants& c) {
  ProfileForm form(c);
  for (const QuadraticBlock& block : form.blocks())
    if (!block.q.allFinite())
      throw std::invalid_argument(fmt::format(
          "the filter's constants overflow: found --sigma-encoder={:g}, --sigma-acceleration={:g}, "
          "--sigma-rotation={:g}, dt {:g} s, L {:g} m, expected sizes that a robot meets",
          c.sigma_encoder, c.sigma_acceleration, c.sigma_rotation, c.dt, c.wheel_distance));
  return form;
}

// The choices that decide what the numbers mean.
std::string setup_note(const EntropyOptions& options, const FilterSetup& setup) {
  const EntropyConstants& c = setup.constants;
  return fmt::format(
      "{}: N {}, dt {:g} s, sigmas {:g} m, {:g} m/s^2, {:g} deg, L {:g} m, steps {:.9g} m/s^2, {:.9g} "
      "deg/s^2; "
      "accelerations {}{}; {}",
      options.as_published ? "as published" : "corrected", c.samples, c.dt, c.sigma_encoder,
      c.sigma_acceleration, c.sigma_rotation, c.wheel_distance, c.step_acceleration, c.step_rotation,
      setup.turn_accelerations ? "turned from the robot's frame" : "in the filter's frame",
      setup.omega_cross_v ? ", less omega x v" : "",
      setup.rotation_sign > 0 ? "wheel 1 front right" : "wheel 1 rear left");
}

// Of a pipe there is nothing left to sum.
std::string checksum(const std::string& data) {
  return fs::is_regular_file(data) ? sha256_of_file(data) : std::string();
}

// What the record says of the run as a whole.
void describe_run(const EntropyOptions& options, const FilterSetup& setup, const FilteredRun& run,
                  RunRecord& record) {
  record.dataset = fs::path(options.data).stem().string();
  record.base_seed = record.seed = options.seed;
  record.termination = run.interrupted ? to_string(Termination::Interrupted) : "complete";
  record.message = run.interrupted ? "interrupted, the windows so far" : "all windows of the run";
  record.notes = {setup_note(options, setup)};
  if (run.unfinished) record.notes.push_back("the last line of the file has no line break; it was taken");
}

}  // namespace

FilteredRun filter_run(const EntropyOptions& options, const Catalogue& catalogue,
                       const TextSink& standard_output, Watcher& watcher, const Stop& stop) {
  const InstructionSet kernel = kernel_in_force(options.kernel);
  FilterSetup setup = make_filter_setup(options);
  // Before the data are read, which may take long or come but once.
  make_filter_method(options.solver, catalogue, profile_of(setup.constants), options.budget, options.seed,
                     kernel, stop);
  const std::string begin_utc = utc_now();
  const Clock::time_point begin = Clock::now();
  const std::unique_ptr<FilterInputs> inputs = open_filter_inputs(options, setup, stop);
  if (options.theta && !inputs->thesis_layout())
    throw std::invalid_argument(fmt::format(
        "--theta={}: {} names its rotation column with a unit; the option is for the thesis' layout",
        *options.theta, options.data));
  setup.constants.dt = inputs->dt();
  for (const std::string& text : inputs->report) watcher.note(text);
  watcher.results_begin();
  FilterRun run(options, catalogue, setup, kernel, *inputs, standard_output, stop);
  watcher.count_begins("windows", 0);
  FilterInput input;
  while (inputs->next(input) && run.push(input))
    if (run.slow() || run.windows() % 1024 == 0) watcher.count_is(run.windows());
  watcher.count_ends();

  FilteredRun result;
  result.interrupted = stop.requested();
  result.windows = run.windows();
  result.unfinished = inputs->unfinished();
  if (result.windows == 0) throw Interruption();
  result.record = run.record(seconds_since(begin));
  describe_run(options, setup, result, result.record);
  for (const std::string& text : run.suspicions()) {
    watcher.warn(text);
    result.record.notes.push_back(text);
  }
  for (const std::string& text : inputs->notes()) {
    watcher.note(text);
    result.record.notes.push_back(text);
  }
  result.record.context = run_context(1, kernel);
  result.record.time_utc = begin_utc;
  run.commit();
  if (options.checksum) result.record.dataset_sha256 = checksum(options.data);
  return result;
}

}  // namespace odobench
