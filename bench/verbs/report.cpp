#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "base/error.hpp"
#include "base/files.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/options/table_options.hpp"
#include "bench/options/written_files.hpp"
#include "bench/studies/figure_files.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/report_study.hpp"
#include "reports/kinds/kinds.hpp"
#include "reports/page/report_document.hpp"
#include "reports/page/web_assets.hpp"

namespace odobench {
namespace {

struct ReportOptions {
  std::vector<std::string> runs;
  std::string out;      // HTML page, "-" for standard output; empty: none
  std::string figures;  // folder for SVG files; empty: none
  std::string title;    // of the page; empty: what was run
  bool overwrite = false;
  std::string format = "console";
  std::vector<std::string> shown;
};

void add_options(CLI::App& app, ReportOptions& o) {
  app.add_option("--out", o.out, "write one self-contained page that needs no network; - for standard output")
      ->type_name("FILE.HTML");
  app.add_option("--figures", o.figures, "write every figure as an SVG file into this folder")
      ->type_name("DIR");
  app.add_option("--title", o.title, "of the page [what was run]")->type_name("TEXT");
  app.add_flag("--overwrite", o.overwrite, "replace the page or the figures that are there");
  app.add_option("runs", o.runs, "folders with runs.jsonl, or .jsonl files")->required();
  add_format(app, o.format);
  add_tables(app, o.shown, TablesByDefault::All);
}

namespace fs = std::filesystem;

ExitCode report_command(const ReportOptions& options) {
  const Format format = parse_format(options.format);
  TerminalWatcher watcher;
  const std::vector<RunRecord> records = read_all_records(options.runs, watcher);
  for (const std::string& sentence : unknown_records(records)) watcher.warn(sentence);
  if (options.out.empty() && options.figures.empty()) {
    return print_chosen(
        record_tables(records, notes_of_best(records), format == Format::Json || format == Format::Csv),
        options.shown, format, TablesByDefault::All);
  }
  const Existing existing = existing_files(options.overwrite);
  refuse_existing("--out", options.out, options.overwrite);
  if (options.out == "-" && format == Format::Json)
    throw std::invalid_argument("--out=-: standard output takes the page, not JSON as well");
  const Document document = make_report(report_input(options.runs, records, options.title));
  std::vector<fs::path> written, drawn;
  // First, since it can still be interrupted.
  if (!options.figures.empty())
    drawn = write_figures(document, options.figures, existing, watcher, InterruptGuard::stop());
  if (!options.out.empty()) {
    const std::string page = render_html(document);
    InterruptGuard::remember();
    write_result(options.out, page, existing);
    if (options.out != "-") written.emplace_back(options.out);
    note(has_chart_library()
             ? fmt::format("{}: {} figures, {} sections", options.out, figures(document).size(),
                           document.sections.size())
             : fmt::format("{}: tables without charts, since {}", options.out, why_no_charts()));
  }
  if (!options.figures.empty()) {
    written.insert(written.end(), drawn.begin(), drawn.end());
    note(fmt::format("{}: {} figures", options.figures, figures(document).size()));
  }
  if (format == Format::Json) print_tables({written_table(written)}, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_report(CLI::App& app) {
  return verb_action<ReportOptions>(app, add_options, report_command);
}

}  // namespace odobench
