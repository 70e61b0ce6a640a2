// Which vector widths this processor offers to the kernels that exist in several (lib/lanes.inc).
#pragma once

#include <vector>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define LFD_X86_WIDTHS  ///< kernels are compiled for AVX2 and AVX-512 beside the baseline and chosen at run time
#endif

namespace lfd {

/// Doubles a vector that this processor can work on, ascending. Kernels give the same bytes at every width.
[[nodiscard]] inline std::vector<int> vector_widths() {
#ifdef LFD_X86_WIDTHS
  if (__builtin_cpu_supports("avx512f")) return {2, 4, 8};
  if (__builtin_cpu_supports("avx2")) return {2, 4};
#endif
  return {2};
}

}  // namespace lfd
