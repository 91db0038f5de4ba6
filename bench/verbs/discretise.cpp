#include "bench/verbs/verbs.hpp"

#include "bench/catalogue/number_text.hpp"
#include "bench/console/table_output.hpp"
#include "bench/options/common_options.hpp"
#include "bench/studies/simulation/discretisation_study.hpp"
#include "problems/kalman/linear_system.hpp"

namespace odobench {
namespace {

struct DiscretiseOptions {
  std::string system;
  DiscretisationStudy study;
  std::string format = "console";
};

void add_options(CLI::App& app, DiscretiseOptions& o) {
  app.add_option("--system", o.system, "JSON file with A and, if there are, B, G and Qc")
      ->required()
      ->type_name("FILE");
  app.add_option_function<std::string>(
         "--period",
         [&o](const std::string& text) { o.study.period = finite_number("--period", text, true, 1e6); },
         "time step, seconds")
      ->required()
      ->type_name("T");
  app.add_option_function<std::string>(
         "--order",
         [&o](const std::string& text) {
           o.study.order = static_cast<int>(whole_number("--order", text, 1, kMaxSeriesOrder - 2));
         },
         "cut the series of the exponential after this power and show the error [exact]")
      ->type_name("N");
  add_format(app, o.format);
}

ExitCode discretise_command(const DiscretiseOptions& options) {
  const Format format = parse_format(options.format);
  DiscretisationStudy study = options.study;
  study.system = options.system;
  const DiscreteSystem discrete = discretise_system(study);
  if (format == Format::Latex)
    print_text(discrete.latex);
  else if (format == Format::Json)
    print_text(discrete.json);
  else
    print_tables(discrete.tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_discretise(CLI::App& app) {
  return verb_action<DiscretiseOptions>(app, add_options, discretise_command);
}

}  // namespace odobench
