// The vector instructions that the kernels of the cost evaluations come in
// (problems/calibration/kernel/kernel.hpp, solvers/lattice/ternary_kernel.hpp), and which of them this
// processor has.
//
// The last bits of a calibration's cost depend on it: other lane counts sum in another order, and the wide
// ones use fused multiply-adds. So results repeat to the last bit for one kernel, and whoever runs something
// says which.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace odobench {

enum class InstructionSet {
  Baseline,  // what every processor of the target has: SSE2, NEON, ...
  Avx2,      // with FMA
  Avx512,    // F, DQ, VL
};

// "baseline", "avx2", "avx512".
const char* to_string(InstructionSet set);

// Of this processor and its operating system, the widest first; `Baseline` is always the last.
const std::vector<InstructionSet>& available_instruction_sets();
InstructionSet widest_instruction_set();
bool is_available(InstructionSet set);

// "auto" is the widest. Throws std::invalid_argument, beginning with `where` ("--kernel"), on another word
// and on a set that the processor does not have, with what it has.
InstructionSet instruction_set(std::string_view where, const std::string& name);

// Throws std::invalid_argument unless the processor has it.
void require_available(InstructionSet set);

}  // namespace odobench
