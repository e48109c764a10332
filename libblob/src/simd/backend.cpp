// SPDX-License-Identifier: Apache-2.0
#include "simd/backend.h"

namespace lumen::blob {
namespace {

bool processorHas(blob_simd simd) noexcept {
#if defined(__GNUC__) && defined(__x86_64__)
  __builtin_cpu_init();
  if (simd == BLOB_SIMD_AVX512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
  if (simd == BLOB_SIMD_AVX2) return __builtin_cpu_supports("avx2");
#endif
  return simd == BLOB_SIMD_SCALAR || simd == BLOB_SIMD_PORTABLE;
}

const Backend* backendOf(blob_simd simd, blob_kernel kernel) noexcept {
  if (!processorHas(simd)) return nullptr;
  switch (simd) {
    case BLOB_SIMD_AVX512:
      return avx512Backend(kernel);
    case BLOB_SIMD_AVX2:
      return avx2Backend(kernel);
    case BLOB_SIMD_PORTABLE:
      return portableBackend(kernel);
    default:
      return scalarBackend(kernel);
  }
}

}  // namespace

const Backend* chooseBackend(blob_kernel kernel, blob_simd& wanted) noexcept {
  int simd = codeOf(wanted);
  if (simd <= BLOB_SIMD_BEST || simd > BLOB_SIMD_AVX512) simd = BLOB_SIMD_AVX512;
  for (; simd > BLOB_SIMD_SCALAR; --simd)
    if (const Backend* backend = backendOf(static_cast<blob_simd>(simd), kernel)) {
      wanted = static_cast<blob_simd>(simd);
      return backend;
    }
  wanted = BLOB_SIMD_SCALAR;
  return scalarBackend(kernel);
}

}  // namespace lumen::blob
