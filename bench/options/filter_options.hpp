// The options of `bench filter`.
#pragma once

#include <CLI/App.hpp>
#include <string>

#include "bench/studies/entropy/entropy_setup.hpp"

namespace odobench {

struct FilterOptions {
  EntropyOptions study;
  std::string records;  // folder for the run record and tables; empty: none
  std::string format = "console";
  bool quiet = false;
};

// Adds the options to `app`, writing to `options`, which must outlive it.
void add_filter_options(CLI::App& app, FilterOptions& options);

}  // namespace odobench
