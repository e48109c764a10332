// SPDX-License-Identifier: Apache-2.0
// Run-time dispatch for hot loops.
#pragma once

/// Put before a function whose loops vectorise over independent lanes: the compiler emits one clone
/// per instruction set and the loader picks the best. Contraction is off in this project and
/// reductions are never reordered, so every clone gives the same bits. Sanitizers cannot start with
/// such dispatch (resolvers run before their runtime), so they get the plain function.
#if defined(LUMEN_NO_CLONES) || !defined(__x86_64__) || !defined(__gnu_linux__)
#define LUMEN_SIMD_CLONES
#else
#define LUMEN_SIMD_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#endif
