#include "bench/check_command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "bench/records.hpp"
#include "bench/table_output.hpp"
#include "bench/written.hpp"
#include "datasets/error.hpp"
#include "datasets/file_io.hpp"
#include "reports/baseline.hpp"

namespace odobench {
std::vector<RunRecord> read_all_records(const std::vector<std::string>& runs) {
  std::vector<RunRecord> records;
  for (const std::string& run : runs) {
    std::filesystem::path path = run;
    if (std::filesystem::is_directory(path)) path /= "runs.jsonl";
    if (!std::filesystem::exists(path))
      throw DataError(fmt::format("{}: there is no such file", path.string()));
    for (RunRecord& r : read_records(path.string())) records.push_back(std::move(r));
  }
  if (records.empty()) throw DataError("no run record in what was given");
  return records;
}

ExitCode check_command(const CheckOptions& options) {
  const Format format = parse_format(options.format);
  const std::vector<RunRecord> records = read_all_records(options.runs);
  if (options.update) {
    Tolerances tolerances;
    if (std::filesystem::exists(options.baseline)) tolerances = read_baseline(options.baseline).tolerances;
    const Baseline baseline = make_baseline(records, tolerances);
    write_file(options.baseline, to_json_text(baseline));
    note(fmt::format("{}: {} entries written", options.baseline, baseline.entries.size()));
    if (format == Format::Json) print_tables({written_table({options.baseline})}, format);
    return ExitCode::Success;
  }
  const BaselineReport report = check_baseline(read_baseline(options.baseline), records);
  print_tables({report.table}, format);
  return report.passed ? ExitCode::Success : ExitCode::CheckFailed;
}

}  // namespace odobench
