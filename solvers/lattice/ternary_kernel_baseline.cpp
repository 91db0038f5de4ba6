#include "solvers/lattice/ternary_kernel_impl.hpp"
#include "solvers/lattice/ternary_kernel_variants.hpp"

namespace odobench::ternary {

Kernel baseline() {
  return make_kernel<2>();
}

}  // namespace odobench::ternary
