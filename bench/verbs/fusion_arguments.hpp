// The verbs about filters: `bench discretise`, `bench fuse`, `bench tune`.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <vector>

#include "bench/console/exit_code.hpp"
#include "bench/verbs/discretise_command.hpp"
#include "bench/verbs/fuse_command.hpp"
#include "bench/verbs/tune_command.hpp"

namespace odobench {

// A verb of the command line and what it does.
struct Verb {
  CLI::App* app;
  std::function<ExitCode()> execute;
};

// --format of the tables that the verb prints.
void add_format(CLI::App& app, std::string& format);

struct FusionArguments {
  DiscretiseOptions discretise;
  FuseOptions fuse;
  TuneOptions tune;
};

// `arguments` must outlive the verbs.
std::vector<Verb> add_fusion_verbs(CLI::App& app, FusionArguments& arguments);

}  // namespace odobench
