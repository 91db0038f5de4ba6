#include "reports/kinds/entropy/entropy_kinds.hpp"

#include <fmt/format.h>

#include "reports/kinds/entropy/entropy_figures.hpp"
#include "reports/kinds/entropy/entropy_tables.hpp"
#include "reports/kinds/entropy/window_tables.hpp"

namespace odobench {
namespace {

void add_filter_page(const KindInput& input, Section& summary, Document& document) {
  std::vector<Table> tables = filter_tables(input.records);
  summary.blocks.emplace_back(tables.front());
  Section section{"filter", "Relative-entropy filter", "Signals before and after the filter.", {}};
  append(std::move(tables), section);
  for (std::size_t i = 0; i < input.records.size(); ++i)
    add_filter_figures(input.records[i], input.records.size() > 1 ? fmt::format("filter{}.", i + 1) : "",
                       section, document);
  finish(std::move(section), document);
}

void add_windows_page(const KindInput& input, Section& summary, Document& document) {
  const std::vector<Table> tables = window_tables(input.records, false);
  for (const Table& table : tables)
    if (table.id == "methods") summary.blocks.emplace_back(table);
  Section section{
      "windows", "Windows of the relative-entropy filter", "The same windows solved by each method.", {}};
  add_window_figure(input.records, "", section, document);
  // The methods before the many windows.
  append(std::vector<Table>(tables.rbegin(), tables.rend()), section);
  finish(std::move(section), document);
}

}  // namespace

RecordKind filter_kind() {
  return {"filter",
          "the relative-entropy filter over a run: -H, gains, noise before and after",
          [](std::string_view problem) { return problem == kFilterProblem; },
          nullptr,
          [](const KindInput& input) { return filter_tables(input.records); },
          add_filter_page,
          nullptr};
}

RecordKind windows_kind() {
  return {"windows", "a window of the filter solved by one method",
          [](std::string_view problem) { return problem == kWindowProblem; }, nullptr,
          [](const KindInput& input) { return window_tables(input.records, input.full_digits); },
          add_windows_page,
          // "FILE/ID": the file is enough.
          [](const RunRecord& r) { return r.dataset.substr(0, r.dataset.find('/')); }};
}

}  // namespace odobench
