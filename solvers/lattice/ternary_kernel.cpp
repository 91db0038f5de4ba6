#include "solvers/lattice/ternary_kernel.hpp"

#include "problems/instruction_set.hpp"
#include "solvers/lattice/ternary_kernel_variants.hpp"

namespace odobench::ternary {

Kernel select(InstructionSet set) {
  require_available(set);
  switch (set) {
#if defined(__x86_64__)
    case InstructionSet::Avx512:
      return avx512();
    case InstructionSet::Avx2:
      return avx2();
#endif
    default:
      return baseline();
  }
}

}  // namespace odobench::ternary
