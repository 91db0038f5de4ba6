#include "bench/verbs/verbs.hpp"

#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/robots.hpp"
#include "bench/options/common_options.hpp"
#include "bench/options/written_files.hpp"
#include "datasets/robots/layouts.hpp"
#include "problems/simulation/demo_generator.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace {

struct DemoOptions {
  std::string out;
  std::string robot = "4wis4wid";     // class
  std::optional<std::uint64_t> seed;  // of the noise; none: that of the demo set in the repository
  bool overwrite = false;
  bool json = false;  // say on standard output what was written
};

void add_options(CLI::App& app, DemoOptions& o) {
  app.add_option("--out", o.out, "folder for set.json")->required()->type_name("DIR");
  app.add_option(
         "--robot", o.robot,
         "class of the robot, see 'bench list robots'; others than 4wis4wid get small sets of squares, "
         "circles and lines [4wis4wid]")
      ->type_name("CLASS");
  app.add_option_function<std::string>(
         "--seed", [&o](const std::string& text) { o.seed = seed_number("--seed", text); },
         "of its noise [that of the set in the repository]")
      ->type_name("N");
  app.add_flag("--overwrite", o.overwrite, "replace a data set that is there");
  add_json(app, o.json);
}

ExitCode demo_command(const DemoOptions& options) {
  const std::filesystem::path set = std::filesystem::path(options.out) / "set.json";
  require_writable(set, existing_files(options.overwrite));
  const std::uint64_t seed = options.seed.value_or(kDemoSeed);
  const std::string kinematics = robots::layout(robot_class(options.robot)).name;
  save_announced(kinematics == "4wis4wid" ? make_demo_dataset(seed) : make_robot_demo(kinematics, seed), set,
                 options.overwrite, options.json);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_demo(CLI::App& app) {
  return verb_action<DemoOptions>(app, add_options, demo_command);
}

}  // namespace odobench
