#include "solvers/ternary_kernel_impl.hpp"
#include "solvers/ternary_kernel_variants.hpp"

namespace odobench::ternary {

Kernel baseline() {
  return make_kernel<2>("baseline");
}

std::span<const Kernel> available() {
  struct List {
    Kernel kernels[3];
    std::size_t count = 0;
  };
  static const List list = [] {
    List l{};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
      l.kernels[l.count++] = avx512();
    if (__builtin_cpu_supports("avx2")) l.kernels[l.count++] = avx2();
#endif
    l.kernels[l.count++] = baseline();
    return l;
  }();
  return {list.kernels, list.count};
}

}  // namespace odobench::ternary
