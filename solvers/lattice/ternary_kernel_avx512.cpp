#if defined(__x86_64__)
#if !defined(__AVX512F__) || !defined(__AVX512DQ__) || !defined(__AVX512VL__)
#error "this file is to be compiled with -mavx512f -mavx512dq -mavx512vl"
#endif
#include "solvers/lattice/ternary_kernel_impl.hpp"
#include "solvers/lattice/ternary_kernel_variants.hpp"

namespace odobench::ternary {

Kernel avx512() {
  return make_kernel<8>();
}

}  // namespace odobench::ternary
#endif
