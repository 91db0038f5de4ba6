#include "bench/fusion_arguments.hpp"

#include "bench/number_text.hpp"
#include "problems/fusion/linear_system.hpp"

namespace odobench {
namespace {

void add_format(CLI::App& app, std::string& format) {
  app.add_option("--format", format, "of the tables [console]")->type_name("console|md|csv|json|latex");
}

Verb add_discretise(CLI::App& app, DiscretiseOptions& o) {
  CLI::App* verb =
      app.add_subcommand("discretise", "F, Psi, Gamma, Q of a linear system x' = A x + B u + G w");
  verb->add_option("--system", o.system, "JSON file with A and, if there are, B, G and Qc")
      ->required()
      ->type_name("FILE");
  verb->add_option_function<std::string>(
          "--period", [&o](const std::string& text) { o.period = finite_number("--period", text, true); },
          "time step, seconds")
      ->required()
      ->type_name("T");
  verb->add_option_function<std::string>(
          "--order",
          [&o](const std::string& text) {
            o.order = static_cast<int>(whole_number("--order", text, 1, kMaxSeriesOrder - 2));
          },
          "cut the series of the exponential after this power and show the error [exact]")
      ->type_name("N");
  add_format(*verb, o.format);
  return {verb, [&o] { return discretise_command(o); }};
}

}  // namespace

std::vector<Verb> add_fusion_verbs(CLI::App& app, FusionArguments& a) {
  return {add_discretise(app, a.discretise)};
}

}  // namespace odobench
