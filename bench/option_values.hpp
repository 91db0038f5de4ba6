// What several verbs do with the values of their options.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problems/instruction_set.hpp"

namespace odobench {

// "a,b," gives a, b and an empty item.
std::vector<std::string> comma_items(const std::string& list);
// Of every list, one after the other.
std::vector<std::string> comma_items(const std::vector<std::string>& lists);

// Throws std::invalid_argument "OPTION=PATH: it exists; ..." unless it may be overwritten; "" is no path.
void refuse_existing(const char* option, const std::string& path, bool overwrite);

// `asked`, or for 0 one per core.
int thread_count(int asked);

// `asked` (the option --kernel), or what the environment variable ODOBENCH_KERNEL says, or the widest of this processor.
// Throws std::invalid_argument on a bad value of the variable, which names it.
InstructionSet kernel_in_force(std::optional<InstructionSet> asked = std::nullopt);

}  // namespace odobench
