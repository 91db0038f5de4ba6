// What several verbs do with the values of their options.
#pragma once

#include <string>
#include <vector>

namespace odobench {

// "a,b," gives a, b and an empty item.
std::vector<std::string> comma_items(const std::string& list);
// Of every list, one after the other.
std::vector<std::string> comma_items(const std::vector<std::string>& lists);

// Throws std::invalid_argument "OPTION=PATH: it exists; ..." unless it may be overwritten; "" is no path.
void refuse_existing(const char* option, const std::string& path, bool overwrite);

// `asked`, or for 0 one per core.
int thread_count(int asked);

}  // namespace odobench
