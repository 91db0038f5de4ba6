#if defined(__x86_64__)
#include "solvers/ternary_kernel_impl.hpp"
#include "solvers/ternary_kernel_variants.hpp"

namespace odobench::ternary {

Kernel avx512() {
  return make_kernel<8>("avx512");
}

}  // namespace odobench::ternary
#endif
