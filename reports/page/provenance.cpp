#include <algorithm>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include "reports/page/report_document.hpp"

namespace odobench {
namespace {

std::string joined(const std::set<std::string>& values) {
  std::string text;
  for (const std::string& value : values)
    if (!value.empty()) text += (text.empty() ? "" : "; ") + value;
  return text;
}

Table setup_table(const std::vector<RunRecord>& records) {
  std::set<std::string> sets, commands, programs, compilers, machines, libraries, kernels, threads, seeds;
  std::string first, last;
  for (const RunRecord& r : records) {
    const RunContext& c = r.context;
    if (!r.dataset.empty() || !r.dataset_sha256.empty())
      sets.insert(r.dataset_sha256.empty() ? r.dataset
                                           : fmt::format("{} (SHA-256 {})", r.dataset, r.dataset_sha256));
    commands.insert(c.command);
    programs.insert(fmt::format("odobench {}, revision {}", c.version, c.git_revision));
    compilers.insert(fmt::format("{}, {}", c.compiler, c.build_type));
    machines.insert(c.cpu);
    libraries.insert(c.libraries);
    kernels.insert(c.kernel);
    threads.insert(std::to_string(c.threads));
    if (r.kind == "run" || r.base_seed != 0) seeds.insert(std::to_string(r.base_seed));
    if (!r.time_utc.empty()) {
      first = first.empty() ? r.time_utc : std::min(first, r.time_utc);
      last = std::max(last, r.time_utc);
    }
  }
  Table table{"setup", "Set-up", {}, {}, {}};
  table.columns = {{"what", "what", "", "", "", Align::Left}, {"value", "value", "", "", "", Align::Left}};
  const auto add = [&](const char* what, const std::string& value) {
    if (!value.empty()) table.rows.push_back({text_cell(what), text_cell(value)});
  };
  add("data", joined(sets));
  add("command", joined(commands));
  add("program", joined(programs));
  add("compiler", joined(compilers));
  add("libraries", joined(libraries));
  add("processor", joined(machines));
  add("kernel", joined(kernels));
  add("threads", joined(threads));
  add("base seed", joined(seeds));
  add("made", first == last ? first : first + " .. " + last);
  return table;
}

std::string option_text(const RunRecord& record) {
  std::string text;
  for (const auto& [key, value] : record.options)
    text += fmt::format("{}{}={}", text.empty() ? "" : ", ", key, value);
  return text;
}

Table run_table(const std::vector<RunRecord>& records) {
  Table table{"runs", "Every record", {}, {}, {}};
  table.columns = {{"label", "label", "", "", "", Align::Left},
                   {"dataset", "data", "", "", "", Align::Left},
                   {"repetition", "repeat", "", "", ""},
                   {"seed", "seed", "", "", "", Align::Left},  // 64 bits are more than a double tells apart
                   {"start", "start", "", "", "", Align::Left},
                   {"cost", "J", "", "$J$", ""},
                   {"evaluations", "evaluations", "", "", ""},
                   {"seconds", "time", "s", "", ""},
                   {"stop", "stop", "", "", "", Align::Left},
                   {"message", "why it stopped", "", "", "", Align::Left},
                   {"options", "options", "", "", "", Align::Left}};
  for (const RunRecord& r : records)
    table.rows.push_back({text_cell(r.label), text_cell(r.dataset),
                          count_cell(static_cast<double>(r.repetition)),
                          text_cell(r.kind == "run" ? std::to_string(r.seed) : ""), text_cell(r.start),
                          r.cost ? significant_cell(*r.cost, 10) : Cell{},
                          count_cell(static_cast<double>(r.evaluations)), fixed_cell(r.seconds, 3),
                          text_cell(r.termination), text_cell(r.message), text_cell(option_text(r))});
  return table;
}

}  // namespace

std::vector<Table> provenance_tables(const std::vector<RunRecord>& records) {
  return {setup_table(records), run_table(records)};
}

}  // namespace odobench
