#if defined(__x86_64__)
#if !defined(__AVX512F__) || !defined(__AVX512DQ__) || !defined(__AVX512VL__) || !defined(__FMA__)
#error "this file is to be compiled with -mavx512f -mavx512dq -mavx512vl -mfma"
#endif
#include "problems/calibration/kernel/kernel_impl.hpp"
#include "problems/calibration/kernel/kernel_variants.hpp"

namespace odobench::kernel {

Kernel avx512() {
  return make_kernel<8>();
}
ModelKernel model_avx512() {
  return make_model_kernel<8>();
}

}  // namespace odobench::kernel
#endif
