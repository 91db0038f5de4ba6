#include "bench/studies/entropy/filter_input.hpp"

#include <fmt/format.h>

#include <deque>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/error.hpp"
#include "base/files.hpp"
#include "datasets/import/logs/filter_log.hpp"

namespace odobench {
namespace {

// Data and truth in step with each other, without the rows at the end that are not to be used.
class CsvInputs final : public FilterInputs {
 public:
  CsvInputs(const EntropyOptions& options, const FilterSetup& setup, const Stop& stop)
      : unused_(static_cast<std::size_t>(setup.rows_unused)), data_(options.data, with_stop(setup, stop)) {
    if (options.truth.empty()) return;
    truth_.emplace(options.truth, setup.truth_columns, stop.flag());
    FilterTruth passed;
    for (std::int64_t i = 0; i < data_.passed_over(); ++i)
      if (!truth_->next(passed) && !truth_->interrupted()) truth_->too_short(data_.file());
  }

  std::string file() const override { return data_.file(); }
  double dt() const override { return data_.dt(); }
  bool has_time() const override { return data_.has_time(); }
  bool thesis_layout() const override { return data_.thesis_layout(); }
  bool unfinished() const override { return data_.unfinished(); }

  bool next(FilterInput& input) override {
    while (ahead_.size() <= unused_)
      if (!read()) return false;
    input = ahead_.front();
    ahead_.pop_front();
    return true;
  }

  std::vector<std::string> notes() const override {
    std::vector<std::string> notes;
    if (data_.jittered() > 0)
      notes.push_back(
          fmt::format("time_s: {} steps differ from the period of {:g} s, by up to {:.2g} s: taken as jitter "
                      "of the stamps",
                      data_.jittered(), data_.dt(), data_.jitter()));
    if (data_.filled() > 0)
      notes.push_back(fmt::format("{} missing rows filled in by --resample", data_.filled()));
    return notes;
  }

 private:
  static FilterRunOptions with_stop(const FilterSetup& setup, const Stop& stop) {
    FilterRunOptions options = setup.reader;
    options.interrupt = stop.flag();
    return options;
  }
  bool interrupted() const { return data_.interrupted() || (truth_ && truth_->interrupted()); }

  bool read() {
    FilterInput input;
    const bool any = data_.next(input.row);
    if (truth_ && !interrupted()) {
      const bool known = truth_->next(input.truth);
      if (interrupted()) return false;
      if (any && !known) truth_->too_short(data_.file());
      if (!any && known) truth_->too_long(data_.file());
    }
    if (any) ahead_.push_back(input);
    return any;
  }

  const std::size_t unused_;
  FilterRunReader data_;
  std::optional<FilterTruthReader> truth_;
  std::deque<FilterInput> ahead_;
};

class LogInputs final : public FilterInputs {
 public:
  LogInputs(log_import::FilterLog log, std::int64_t unused) : log_(std::move(log)) {
    report = std::move(log_.notes);
    const auto rows = static_cast<std::int64_t>(log_.rows.size());
    log_.rows.resize(static_cast<std::size_t>(std::max<std::int64_t>(0, rows - unused)));
  }

  std::string file() const override { return log_.id; }
  double dt() const override { return log_.dt; }
  bool has_time() const override { return true; }
  bool next(FilterInput& input) override {
    if (next_ == log_.rows.size()) return false;
    input.row = log_.rows[next_++];
    return true;
  }
  std::vector<std::string> notes() const override {
    std::vector<std::string> notes{fmt::format("{}: {} rows, one every {:g} s, by the clock of the wheels",
                                               log_.id, log_.rows.size(), log_.dt)};
    if (log_.filled > 0) notes.push_back(fmt::format("{} rows in gaps filled in by --resample", log_.filled));
    return notes;
  }

 private:
  log_import::FilterLog log_;
  std::size_t next_ = 0;
};

// What speaks of columns of a CSV file.
void refuse_csv_options(const EntropyOptions& o) {
  for (const auto& [given, option] : {std::pair{!o.truth.empty(), "--truth"},
                                      {!o.columns.empty(), "--columns"},
                                      {!o.truth_columns.empty(), "--truth-columns"},
                                      {o.theta.has_value(), "--theta"},
                                      {o.time_tolerance.has_value(), "--time-tolerance"},
                                      {o.wheel_order.has_value(), "--wheel-order"}})
    if (given) throw std::invalid_argument(fmt::format("{} is of CSV data; with --map leave it out", option));
}

void take_sizes(const log_import::FilterLog& log, EntropyConstants& constants) {
  const EntropyConstants usual;
  const auto take = [](double& value, double by_default, double found) {
    if (value == by_default) value = found;
  };
  take(constants.length, usual.length, log.length);
  take(constants.width, usual.width, log.width);
  take(constants.wheel_distance, usual.wheel_distance, log.wheel_distance);
  validate(constants);
}

}  // namespace

std::unique_ptr<FilterInputs> open_filter_inputs(const EntropyOptions& options, FilterSetup& setup,
                                                 const Stop& stop) {
  if (options.map.empty()) return std::make_unique<CsvInputs>(options, setup, stop);
  refuse_csv_options(options);
  const log_import::LogMap map =
      log_import::parse_log_map(read_file(options.map), options.map, {}, log_import::MapUse::Filter);
  std::vector<std::filesystem::path> logs;
  for (const std::string& log : comma_items(options.data)) logs.emplace_back(log);
  const std::vector<log_import::LogGroup> groups = log_import::group_logs(map, logs);
  if (groups.size() != 1)
    throw std::invalid_argument(
        fmt::format("--data={}: found {} drives, expected the logs of one", options.data, groups.size()));
  log_import::FilterLog log = log_import::filter_log(
      map, log_import::read_curves(map, groups.front(), options.log, stop), {options.dt, options.resample});
  const std::int64_t needed = setup.reader.least_rows;
  if (static_cast<std::int64_t>(log.rows.size()) < needed)
    throw DataError(fmt::format("{}: found {} rows of {:g} s, expected at least {} (a window)", log.id,
                                log.rows.size(), log.dt, needed));
  take_sizes(log, setup.constants);
  return std::make_unique<LogInputs>(std::move(log), setup.rows_unused);
}

}  // namespace odobench
