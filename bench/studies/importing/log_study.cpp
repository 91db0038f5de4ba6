#include "bench/studies/importing/log_study.hpp"

#include <algorithm>

#include "base/json_node.hpp"
#include "base/text.hpp"
#include "bench/studies/importing/heading_reference.hpp"
#include "bench/studies/importing/log_alignment.hpp"
#include "datasets/import/logs/log_import.hpp"
#include "datasets/logs/formats.hpp"
#include "datasets/native/dataset_format.hpp"

namespace odobench {

bool is_dataset(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file) || file.extension() != ".json") return false;
  const JsonNode root = JsonNode::read(file);
  return root.is_object() && root.text_or_empty("schema") == kDatasetSchema;
}

ImportedLogs import_logs(const LogStudy& study, Watcher& watcher, const Stop& stop) {
  const log_import::LoadedLogs loaded =
      log_import::load_logs(study.map, study.map_file, study.logs, study.options, stop, study.poses);
  ImportedLogs out;
  for (const log_import::LogCurves& log : loaded.logs)
    out.report.insert(out.report.end(), log.report.begin(), log.report.end());
  LogAlignment aligned = align_logs(loaded, stop);
  for (const std::string& text : aligned.warnings) watcher.warn(text);
  out.dataset = make_dataset(loaded, aligned.adjustment, &out.sensors);
  complete_heading_reference(out.dataset);
  for (std::string& text : aligned.report) out.dataset.notes.push_back(std::move(text));
  for (std::string& text : log_import::describe_drives(out.dataset)) out.report.push_back(std::move(text));
  return out;
}

std::vector<Table> log_tables(const std::filesystem::path& path, const LogOptions& options,
                              const Stop& stop) {
  const std::unique_ptr<LogFile> log = open_log(path, options);
  Table sources{
      "sources",
      printable(path.filename().string()) + ": " + log->format(),
      {text_column("source"), text_column("type"), number_column("rows"), number_column("rate", "", "Hz"),
       number_column("length", "", "s"), number_column("gap", "longest gap", "s"),
       number_column("delay", "stamp minus log", "ms"), text_column("remark")},
      {},
      {}};
  Table fields{"fields",
               "Their fields",
               {text_column("source"), text_column("field"), text_column("type"), text_column("first")},
               {},
               {}};
  for (const LogSource& source : log->sources(stop)) {
    const double length = static_cast<double>(source.last_ns - source.first_ns) * 1e-9;
    const std::string name = printable(source.name);
    sources.rows.push_back(
        {text_cell(name), text_cell(printable(source.type)), count_cell(static_cast<double>(source.rows)),
         length > 0 ? fixed_cell(static_cast<double>(source.rows - 1) / length, 2) : Cell{},
         fixed_cell(length, 3), fixed_cell(static_cast<double>(source.largest_gap_ns) * 1e-9, 3),
         source.stamp_minus_log_ns ? fixed_cell(static_cast<double>(*source.stamp_minus_log_ns) * 1e-6, 2)
                                   : Cell{},
         text_cell(printable(source.unreadable))});
    for (const LogField& field : source.fields)
      fields.rows.push_back({text_cell(name), text_cell(printable(field.path)),
                             text_cell(printable(field.type)), text_cell(printable(field.first))});
  }
  return {sources, fields};
}

}  // namespace odobench
