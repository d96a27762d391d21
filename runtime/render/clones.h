// PROBE_CLONES before a function compiles it once per CPU generation where the compiler can
// (CMakeLists.txt checks). Contraction is off, so every version computes the same bits.
#pragma once

#if defined(PROBE_TARGET_CLONES)
#define PROBE_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define PROBE_CLONES
#endif

// Before a loop: no step reads what another writes.
#if defined(__clang__)
#define PROBE_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define PROBE_INDEPENDENT _Pragma("GCC ivdep")
#endif
