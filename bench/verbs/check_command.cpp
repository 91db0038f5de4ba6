#include "bench/verbs/check_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <set>
#include <stdexcept>
#include <tuple>

#include "base/error.hpp"
#include "base/files.hpp"
#include "base/sha256.hpp"
#include "base/text.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/studies/records.hpp"
#include "bench/verbs/written_files.hpp"
#include "reports/regression/baseline.hpp"

namespace odobench {
std::vector<RunRecord> read_all_records(const std::vector<std::string>& runs) {
  std::vector<RunRecord> records;
  std::set<std::string> seen;  // check sums: two runs never agree in every digit of their times
  std::size_t repeated = 0;
  for (const std::string& run : runs) {
    std::filesystem::path path = run;
    if (std::filesystem::is_directory(path)) path /= "runs.jsonl";
    if (!std::filesystem::exists(path))
      throw DataError(fmt::format("{}: there is no such file", path.string()));
    for (RunRecord& r : read_records(path.string())) {
      if (seen.insert(sha256(to_json_line(r))).second)
        records.push_back(std::move(r));
      else
        ++repeated;
    }
  }
  if (repeated > 0)
    note(fmt::format("{} record{} read twice and counted once", repeated, repeated == 1 ? " was" : "s were"));
  if (records.empty())
    throw DataError(fmt::format("{}: found no run record, expected at least one",
                                shown(fmt::format("{}", fmt::join(runs, ", ")))));
  return records;
}

ExitCode check_command(const CheckOptions& options) {
  const Format format = parse_format(options.format);
  const std::vector<RunRecord> records = read_all_records(options.runs);
  if (options.update) {
    Baseline before;
    if (std::filesystem::exists(options.baseline)) before = read_baseline(options.baseline);
    Baseline baseline = make_baseline(records, before.tolerances);
    for (BaselineEntry& entry : baseline.entries)
      for (const BaselineEntry& old : before.entries)
        if (std::tie(old.problem, old.dataset, old.label) ==
            std::tie(entry.problem, entry.dataset, entry.label))
          entry.tolerances = old.tolerances;
    InterruptGuard::remember();
    write_file(options.baseline, to_json_text(baseline));
    note(fmt::format("{}: {} entries written", options.baseline, baseline.entries.size()));
    if (format == Format::Json) print_tables({written_table({options.baseline})}, format);
    return ExitCode::Success;
  }
  const BaselineReport report = check_baseline(read_baseline(options.baseline), records);
  print_tables({report.table}, format);
  if (report.compared == 0)
    warn(fmt::format("nothing to compare: no entry of {} meets a record", options.baseline));
  return report.passed ? ExitCode::Success : ExitCode::CheckFailed;
}

}  // namespace odobench
