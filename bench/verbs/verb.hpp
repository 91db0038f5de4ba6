// What every verb of the command line gives: its options and what it does with them.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <memory>

#include "bench/catalogue/catalogue.hpp"
#include "bench/console/exit_code.hpp"

namespace odobench {

// To be called once the command line is parsed; holds the options, so it must live until then.
using VerbAction = std::function<ExitCode(const Catalogue&)>;

template <class Options>
VerbAction verb_action(CLI::App& app, void (*add_options)(CLI::App&, Options&),
                       ExitCode (*call)(const Options&)) {
  const auto options = std::make_shared<Options>();
  add_options(app, *options);
  return [options, call](const Catalogue&) { return call(*options); };
}
// Of a verb that looks names up.
template <class Options>
VerbAction verb_action(CLI::App& app, void (*add_options)(CLI::App&, Options&),
                       ExitCode (*call)(const Options&, const Catalogue&)) {
  const auto options = std::make_shared<Options>();
  add_options(app, *options);
  return [options, call](const Catalogue& catalogue) { return call(*options, catalogue); };
}

}  // namespace odobench
