#include "problems/instruction_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace odobench {
namespace {

constexpr InstructionSet kAll[] = {InstructionSet::Avx512, InstructionSet::Avx2, InstructionSet::Baseline};

bool processor_has(InstructionSet set) {
  switch (set) {
#if defined(__x86_64__)
    case InstructionSet::Avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma");
    case InstructionSet::Avx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
    case InstructionSet::Baseline:
      return true;
    default:
      return false;
  }
}

std::string names_of_available() {
  std::string names;
  for (const InstructionSet set : available_instruction_sets())
    names += (names.empty() ? "" : ", ") + std::string(to_string(set));
  return names;
}

}  // namespace

const char* to_string(InstructionSet set) {
  switch (set) {
    case InstructionSet::Avx512:
      return "avx512";
    case InstructionSet::Avx2:
      return "avx2";
    case InstructionSet::Baseline:
      break;
  }
  return "baseline";
}

const std::vector<InstructionSet>& available_instruction_sets() {
  static const std::vector<InstructionSet> list = [] {
    std::vector<InstructionSet> sets;
    std::copy_if(std::begin(kAll), std::end(kAll), std::back_inserter(sets), processor_has);
    return sets;
  }();
  return list;
}

InstructionSet widest_instruction_set() {
  return available_instruction_sets().front();
}

bool is_available(InstructionSet set) {
  const std::vector<InstructionSet>& list = available_instruction_sets();
  return std::find(list.begin(), list.end(), set) != list.end();
}

InstructionSet instruction_set(std::string_view where, const std::string& name) {
  if (name == "auto") return widest_instruction_set();
  for (const InstructionSet set : kAll) {
    if (name != to_string(set)) continue;
    if (is_available(set)) return set;
    throw std::invalid_argument(fmt::format("{}={}: this processor has no such kernel; it has {}", where,
                                            name, names_of_available()));
  }
  throw std::invalid_argument(
      fmt::format("{}={}: expected auto, avx512, avx2 or baseline; this processor has {}", where, name,
                  names_of_available()));
}

void require_available(InstructionSet set) {
  if (!is_available(set))
    throw std::invalid_argument(fmt::format("kernel {}: this processor does not have it; it has {}",
                                            to_string(set), names_of_available()));
}

}  // namespace odobench
