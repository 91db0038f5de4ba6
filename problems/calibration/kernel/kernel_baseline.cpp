#include "problems/calibration/kernel/kernel_impl.hpp"
#include "problems/calibration/kernel/kernel_variants.hpp"

namespace odobench::kernel {

Kernel baseline() {
  return make_kernel<2>();
}
ModelKernel model_baseline() {
  return make_model_kernel<2>();
}

}  // namespace odobench::kernel
