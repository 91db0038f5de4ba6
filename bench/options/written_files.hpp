// What a verb without tables of its own says with --json: the files it wrote.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/dataset.hpp"
#include "datasets/sensor_rows.hpp"
#include "reports/render/table.hpp"

namespace odobench {

// "written": path, size in bytes and SHA-256 of each file, read back from the disc. Throws DataError when one
// cannot be read.
Table written_table(const std::vector<std::filesystem::path>& files);

// "dataset": one row of name, counts and duration.
Table dataset_table(const Dataset& dataset);

// Writes a data set and says so: a line on standard error (unless `quiet`), with `json` the table of files on
// standard output. `sensors` go to files beside it (datasets/native/sensor_files.hpp).
void save_announced(const Dataset& dataset, const std::filesystem::path& set, bool overwrite, bool json,
                    bool quiet = false, const SetSensors& sensors = {});

}  // namespace odobench
