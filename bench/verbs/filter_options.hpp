// The options of `bench filter`.
#pragma once

#include <CLI/App.hpp>

#include "bench/studies/entropy_setup.hpp"

namespace odobench {

// Adds the options to `app`, writing to `options`, which must outlive it.
void add_filter_options(CLI::App& app, EntropyOptions& options);

}  // namespace odobench
