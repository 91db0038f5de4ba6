#if defined(__x86_64__)
#if !defined(__AVX2__)
#error "this file is to be compiled with -mavx2"
#endif
#include "solvers/lattice/ternary_kernel_impl.hpp"
#include "solvers/lattice/ternary_kernel_variants.hpp"

namespace odobench::ternary {

Kernel avx2() {
  return make_kernel<4>();
}

}  // namespace odobench::ternary
#endif
