// One kernel, several instruction sets. A kernel is written once, from SWARF_KERNEL_INLINE functions; one
// short function for each instruction set carries its attribute and takes the kernel in. All round alike (no
// fused multiply-add), so the processor decides on the speed and not on the result: the tests compare
// the bits.
//
// By attributes, not by a compiler's flag for each file: with a flag, the inline functions of the standard
// library in that file would be compiled for the newer set as well, and the linker keeps one of them for all
// files.
#pragma once

#include <vector>

namespace swarf {

#define SWARF_KERNEL_INLINE inline __attribute__((always_inline))

// clang knows the names of the instruction sets from version 16 on.
#if defined(__x86_64__) && !(defined(__clang_major__) && __clang_major__ < 16)
#define SWARF_X86_64_V3 __attribute__((target("arch=x86-64-v3")))
#define SWARF_X86_64_V4 __attribute__((target("arch=x86-64-v4")))
#define SWARF_X86_64_V4_WIDE __attribute__((target("arch=x86-64-v4,prefer-vector-width=512")))
inline bool runs_x86_64_v3() {
  return __builtin_cpu_supports("x86-64-v3") != 0;
}
inline bool runs_x86_64_v4() {
  return __builtin_cpu_supports("x86-64-v4") != 0;
}
#else
#define SWARF_X86_64_V3
#define SWARF_X86_64_V4
#define SWARF_X86_64_V4_WIDE
inline bool runs_x86_64_v3() {
  return false;
}
inline bool runs_x86_64_v4() {
  return false;
}
#endif

/// Those of a kernel's variants that this processor runs, fastest first.
template <typename Variant>
std::vector<Variant> runnable(const Variant& v4, const Variant& v3, const Variant& baseline) {
  std::vector<Variant> variants;
  if (runs_x86_64_v4()) variants.push_back(v4);
  if (runs_x86_64_v3()) variants.push_back(v3);
  variants.push_back(baseline);
  return variants;
}

}  // namespace swarf
