// The options of `bench filter` and `bench windows`.
#pragma once

#include <CLI/App.hpp>

#include "bench/verbs/command_options.hpp"

namespace odobench {

// Add the options to `app`, writing to `options`, which must outlive it.
void add_filter_options(CLI::App& app, FilterOptions& options);
void add_windows_options(CLI::App& app, WindowsOptions& options);

}  // namespace odobench
