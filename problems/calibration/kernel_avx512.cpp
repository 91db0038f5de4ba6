#if defined(__x86_64__)
#include "problems/calibration/kernel_impl.hpp"
#include "problems/calibration/kernel_variants.hpp"

namespace odobench::kernel {

Kernel avx512() {
  return make_kernel<8>("avx512");
}

}  // namespace odobench::kernel
#endif
