// What several verbs do with the values of their options.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "problems/instruction_set.hpp"

namespace odobench {

// Ends runs whose method would go on for very long; --max-evals=none lifts it.
inline constexpr std::int64_t kDefaultMaxEvaluations = 50000;

// "a,b," gives a, b and an empty item.
std::vector<std::string> comma_items(const std::string& list);
// Of every list, one after the other.
std::vector<std::string> comma_items(const std::vector<std::string>& lists);

Existing existing_files(bool overwrite);

// require_writable() for the value of an option; "" and "-" (standard output) are no files.
void refuse_existing(const char* option, const std::string& path, bool overwrite);
// Of a folder to write into: throws std::invalid_argument when it is there and may not be overwritten.
void refuse_existing_folder(const char* option, const std::string& path, bool overwrite);

// `asked`, or for 0 one per core.
int thread_count(int asked);

// `asked` (the option --kernel), or what the environment variable ODOBENCH_KERNEL says, or the widest of this
// processor. Throws std::invalid_argument on a bad value of the variable, which names it.
InstructionSet kernel_in_force(std::optional<InstructionSet> asked = std::nullopt);

}  // namespace odobench
