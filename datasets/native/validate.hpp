// What holds for every data set on disk, except for the columns of its recordings (find_fault in
// columns.hpp).
#pragma once

#include <string>

#include "base/error.hpp"
#include "datasets/dataset.hpp"

namespace odobench {

// Throws DataError "file: /json/path: found ..., expected ..." unless: names are not empty and unique; a
// 4wis4wid robot has the twelve parameters a1..a4, b1..b4, r1..r4 in metres (or ties); lower <=
// nominal <= upper, all finite; at least one recording; ids are of letters, digits, _, -, . (they become
// file names); recordings refer to a trajectory of the set; repetitions count from 1 and occur once per
// trajectory; known parameters have one finite value per robot parameter; sums are 64 hexadecimal digits.
void validate_dataset(const Dataset& dataset, const std::string& file);

// The robot's part of it alone, for a reader that needs the names of the parameters before it has the rest.
void validate_robot(const Robot& robot, const std::string& file);

}  // namespace odobench
