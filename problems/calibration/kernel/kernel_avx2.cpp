#if defined(__x86_64__)
#if !defined(__AVX2__) || !defined(__FMA__)
#error "this file is to be compiled with -mavx2 -mfma"
#endif
#include "problems/calibration/kernel/kernel_impl.hpp"
#include "problems/calibration/kernel/kernel_variants.hpp"

namespace odobench::kernel {

Kernel avx2() {
  return make_kernel<4>();
}
ModelKernel model_avx2() {
  return make_model_kernel<4>();
}

}  // namespace odobench::kernel
#endif
