// Parameters that runs on one data set found, to be judged on another.
#pragma once

#include <string>
#include <vector>

#include "bench/studies/parameter_sets.hpp"

namespace odobench {

// Every entry of --parameters of `bench evaluate`, `fuse` and `tune`: names and files as read_parameters()
// has them, and besides a folder of a run, or its runs.jsonl, for the parameters of the best run by J of each
// of its rows, and SOURCE:ROW for one row. They are labelled "ROW@FOLDER" after the folder. The set's own
// nominal parameters come first where a folder is given; those of the folder are left out unless they are
// named.
//
// Parameters are taken by name. Throws DataError where names or units differ, saying which, and where nothing
// is in the records; std::invalid_argument for a row that is not there and where two sets have one label. A
// note says where nominal values differ, and that the data are not those of the calibration.
std::vector<ParameterSet> read_judged_parameters(const LoadedProblem& loaded,
                                                 const std::vector<std::string>& lists, Watcher& watcher);

}  // namespace odobench
