// What every verb of the command line gives: its options and what it does with them.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <memory>

#include "bench/console/exit_code.hpp"

namespace odobench {

// To be called once the command line is parsed; holds the options, so it must live until then.
using VerbAction = std::function<ExitCode()>;

template <class Options>
VerbAction verb_action(CLI::App& app, void (*add_options)(CLI::App&, Options&),
                       ExitCode (*call)(const Options&)) {
  const auto options = std::make_shared<Options>();
  add_options(app, *options);
  return [options, call] { return call(*options); };
}

}  // namespace odobench
