// The compiled widths; avx2() and avx512() exist on x86-64 only.
#pragma once

#include "problems/calibration/kernel/kernel.hpp"
#include "problems/calibration/kernel/wheels.hpp"

namespace odobench::kernel {

Kernel baseline();  // 2 lanes: SSE2, NEON, or whatever every processor of the target has
Kernel avx2();      // 4 lanes with fused multiply-add
Kernel avx512();    // 8 lanes

ModelKernel model_baseline();
ModelKernel model_avx2();
ModelKernel model_avx512();

}  // namespace odobench::kernel
