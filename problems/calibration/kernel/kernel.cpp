#include "problems/calibration/kernel/kernel.hpp"

#include "problems/calibration/kernel/kernel_variants.hpp"
#include "problems/instruction_set.hpp"

namespace odobench::kernel {

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

ModelKernel select_model(InstructionSet set) {
  require_available(set);
  switch (set) {
#if defined(__x86_64__)
    case InstructionSet::Avx512:
      return model_avx512();
    case InstructionSet::Avx2:
      return model_avx2();
#endif
    default:
      return model_baseline();
  }
}

}  // namespace odobench::kernel
