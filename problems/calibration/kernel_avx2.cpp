#if defined(__x86_64__)
#include "problems/calibration/kernel_impl.hpp"
#include "problems/calibration/kernel_variants.hpp"

namespace odobench::kernel {

Kernel avx2() {
  return make_kernel<4>("avx2");
}

}  // namespace odobench::kernel
#endif
