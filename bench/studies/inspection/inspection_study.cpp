#include "bench/studies/inspection/inspection_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/error.hpp"
#include "base/text.hpp"
#include "bench/catalogue/locations.hpp"
#include "bench/catalogue/option_values.hpp"
#include "problems/inspection/inspect.hpp"

namespace odobench {
namespace {

using inspection::Severity;

constexpr std::size_t kMostLines = 6;

Cell number_or_nothing(std::optional<std::size_t> number) {
  return number ? count_cell(static_cast<double>(*number)) : Cell{};
}

std::vector<Cell> people_row(const inspection::Finding& f) {
  return {text_cell(std::string(name_of(f.severity))), text_cell(f.kind), text_cell(printable(f.message)),
          text_cell(std::string(f.fix()))};
}

std::vector<Cell> machine_row(const inspection::Finding& f) {
  std::vector<Cell> row = people_row(f);
  const std::optional<std::size_t> first = f.first ? f.first : f.sample, last = f.last ? f.last : f.sample;
  row.insert(row.begin() + 2, {text_cell(printable(f.recording)),
                               f.wheel > 0 ? count_cell(static_cast<double>(f.wheel)) : Cell{},
                               number_or_nothing(first), number_or_nothing(last)});
  return row;
}

}  // namespace

InspectedSet inspect_set(const std::string& data) {
  const std::filesystem::path path = data.empty() ? demo_set() : std::filesystem::path(data);
  InspectedSet inspected{load_dataset(path), {}};
  try {
    inspected.findings = inspection::inspect(inspected.dataset.robot, inspected.dataset.recordings, 0);
  } catch (const std::invalid_argument& error) {  // what is wrong with the set is no usage error
    throw DataError(fmt::format("{}: {}", path.string(), error.what()));
  }
  return inspected;
}

std::vector<inspection::Finding> inspect_recordings(const Robot& robot, std::span<const Recording> recordings,
                                                    int threads) {
  try {
    return inspection::inspect(robot, recordings, threads);
  } catch (const std::runtime_error&) {
    return {};
  } catch (const std::invalid_argument&) {
    return {};
  }
}

std::vector<Table> findings_tables(const std::string& dataset,
                                   const std::vector<inspection::Finding>& findings, bool all) {
  Table table{"findings",
              fmt::format("Findings in data set {}", printable(dataset)),
              {text_column("severity"), text_column("kind")},
              {},
              {}};
  if (all)
    for (const Column& column :
         {text_column("recording"), number_column("wheel"), number_column("first"), number_column("last")})
      table.columns.push_back(column);
  table.columns.push_back(text_column("message"));
  table.columns.push_back(text_column("fix"));
  Table figures{"figures",
                "Figures of the findings",
                {number_column("finding"), text_column("figure"), number_column("value")},
                {},
                {}};
  for (std::size_t i = 0; i < findings.size(); ++i) {
    table.rows.push_back(all ? machine_row(findings[i]) : people_row(findings[i]));
    for (const auto& [name, value] : findings[i].figures)
      figures.rows.push_back(
          {count_cell(static_cast<double>(i + 1)), text_cell(name), significant_cell(value, 6)});
  }
  if (findings.empty()) table.notes.push_back("Nothing was found.");
  if (!all) return {table};
  return {table, figures};
}

bool AcceptedKinds::holds(const std::string& kind) const {
  return all || std::find(names.begin(), names.end(), kind) != names.end();
}

AcceptedKinds accepted_kinds(const std::vector<std::string>& lists) {
  AcceptedKinds accepted;
  for (const std::string& name : comma_items(lists)) {
    if (name == "all") {
      accepted.all = true;
      continue;
    }
    try {
      accepted.names.emplace_back(inspection::kind_called(name).name);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("--accept={}: {}", shown(name), error.what()));
    }
  }
  return accepted;
}

std::vector<std::string> told_findings(const std::vector<inspection::Finding>& findings,
                                       const std::string& place, Watcher& watcher) {
  std::vector<std::string> notes;
  for (const inspection::Finding& f : findings)
    if (f.severity != Severity::Note) notes.push_back(fmt::format("{}: {}", f.kind, f.message));
  for (std::size_t i = 0; i < notes.size() && i < kMostLines; ++i) watcher.warn(notes[i]);
  if (notes.size() > kMostLines)
    watcher.warn(fmt::format("and {} more: bench inspect {}", notes.size() - kMostLines, place));
  return notes;
}

std::vector<std::string> say_findings(const LoadedProblem& loaded, const AcceptedKinds& accepted,
                                      bool calibrates, int threads, Watcher& watcher) {
  if (!loaded.calibration || !loaded.dataset) return {};
  std::vector<Recording> all;  // with what was left out, of which it is to be known why
  if (!loaded.set_aside.empty()) all = loaded.all_recordings();
  std::vector<inspection::Finding> findings = inspect_recordings(
      loaded.dataset->robot, all.empty() ? loaded.calibration->recordings() : all, threads);
  std::erase_if(findings, [](const inspection::Finding& f) { return f.kind == "layout_asymmetric"; });
  for (const inspection::Finding& f : findings)
    if (calibrates && f.severity == Severity::Error && !accepted.holds(f.kind))
      throw DataError(fmt::format("{}: {}: {}; {}{}, or calibrate as it is with --accept={}",
                                  loaded.dataset_path, f.kind, f.message, f.fix(),
                                  f.mendable ? " (bench inspect --fix does it)" : "", f.kind));
  return told_findings(findings, loaded.dataset_path, watcher);
}

}  // namespace odobench
