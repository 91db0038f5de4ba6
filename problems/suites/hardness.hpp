// What makes a problem hard, in a line, for the families that have no such line of their own.
#pragma once

#include <string>

#include "problems/classic/classic_problems.hpp"

namespace odobench {

// ClassicEntry::hard where there is one; else of classic, nist and mgh by name, with what their start
// adds; "" for a problem that it does not know. nist: the level of difficulty is NIST's.
std::string what_is_hard(const ClassicEntry& entry);

}  // namespace odobench
