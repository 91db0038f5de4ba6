// The figures of a report as SVG files.
#pragma once

#include <filesystem>
#include <vector>

#include "base/files.hpp"
#include "base/stop.hpp"
#include "bench/studies/watcher.hpp"
#include "reports/figures/document.hpp"

namespace odobench {

// Writes FOLDER/ID.svg for every figure, in the colours of print and with what its parameters are set to; the
// folder is made if there is none; files that are there are replaced or refused (std::invalid_argument).
// Gives the files: all of them are there in the end, or none is new. All are drawn by one process of node
// with the chart library of this binary. Throws std::runtime_error with one line when there is no node, no
// chart library, or a figure cannot be drawn.
std::vector<std::filesystem::path> write_figures(const Document& document,
                                                 const std::filesystem::path& folder, Existing existing,
                                                 Watcher& watcher, const Stop& stop);

}  // namespace odobench
