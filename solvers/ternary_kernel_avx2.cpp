#if defined(__x86_64__)
#include "solvers/ternary_kernel_impl.hpp"
#include "solvers/ternary_kernel_variants.hpp"

namespace odobench::ternary {

Kernel avx2() {
  return make_kernel<4>("avx2");
}

}  // namespace odobench::ternary
#endif
