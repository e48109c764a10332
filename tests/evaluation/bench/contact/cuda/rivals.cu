// SPDX-License-Identifier: Apache-2.0 What libblob is measured against on a graphics processor: the
// nearest point of a mesh by a tree of boxes, and a texture of distances.
#include <stdint.h>

#pragma clang force_cuda_host_device begin
#include "../../methods/closest_point.h"
#pragma clang force_cuda_host_device end

#define __device__ __attribute__((device))
#define __global__ __attribute__((global))

namespace {

using lumen::bench::closestOnTriangle;
using lumen::bench::Feature;

typedef float Float4 __attribute__((ext_vector_type(4)));
typedef int32_t Int4 __attribute__((ext_vector_type(4)));

__device__ uint32_t threadIndex() {
  return __nvvm_read_ptx_sreg_ctaid_x() * __nvvm_read_ptx_sreg_ntid_x() +
         __nvvm_read_ptx_sreg_tid_x();
}

__device__ float outside(float p, float low, float high) {
  return __builtin_fmaxf(__builtin_fmaxf(low - p, p - high), 0.0f);
}

// The nearest triangle, and the square of its distance.
struct Nearest {
  int32_t triangle;
  float square;
};

constexpr int kMostWaiting = 64;

__device__ Nearest nearestTriangle(const Float4* __restrict__ nodes,
                                   const Float4* __restrict__ corner, const float* p,
                                   float reachSquare) {
  Nearest best{-1, reachSquare};
  int32_t waiting[kMostWaiting];
  float distance[kMostWaiting];
  int count = 0;
  int32_t node = 0;
  for (;;) {
    bool enters = true;
    while (node >= 0 && enters) {
      const Float4* n = nodes + 4 * static_cast<int64_t>(node);
      const Float4 first = n[0], second = n[1], z = n[2];
      const Int4 child = *reinterpret_cast<const Int4*>(n + 3);
      const float x0 = outside(p[0], first.x, first.y), y0 = outside(p[1], first.z, first.w),
                  z0 = outside(p[2], z.x, z.y);
      const float x1 = outside(p[0], second.x, second.y), y1 = outside(p[1], second.z, second.w),
                  z1 = outside(p[2], z.z, z.w);
      const float d0 = x0 * x0 + y0 * y0 + z0 * z0, d1 = x1 * x1 + y1 * y1 + z1 * z1;
      const bool swaps = d1 < d0;
      const float nearSquare = swaps ? d1 : d0, farSquare = swaps ? d0 : d1;
      enters = nearSquare < best.square;
      node = swaps ? child.y : child.x;
      if (farSquare < best.square && count < kMostWaiting) {
        waiting[count] = swaps ? child.x : child.y;
        distance[count++] = farSquare;
      }
    }
    if (enters) {
      const int32_t first = ~node >> 3, number = ~node & 7;
      for (int32_t t = first; t < first + number; ++t) {
        const Float4 a = corner[3 * static_cast<int64_t>(t)],
                     b = corner[3 * static_cast<int64_t>(t) + 1],
                     c = corner[3 * static_cast<int64_t>(t) + 2];
        const float pa[3] = {a.x, a.y, a.z}, pb[3] = {b.x, b.y, b.z}, pc[3] = {c.x, c.y, c.z};
        float q[3];
        closestOnTriangle(p, pa, pb, pc, q);
        const float square = lumen::bench::squareOf(p, q);
        if (square < best.square) best = Nearest{t, square};
      }
    }
    do {
      if (count == 0) return best;
      --count;
    } while (!(distance[count] < best.square));
    node = waiting[count];
  }
}

}  // namespace

// Distance and outward normal of each point, four floats; `last`: null, or the point and the
// distance of the step before, four floats each, so that the wall is looked for no farther than
// that distance and the way since.
extern "C" __global__ void nearest_in_mesh(const Float4* __restrict__ nodes,
                                           const Float4* __restrict__ corner,
                                           const Float4* __restrict__ normal, uint32_t count,
                                           const float* __restrict__ point,
                                           Float4* __restrict__ last, Float4* __restrict__ answer) {
  const uint32_t i = threadIndex();
  if (i >= count) return;
  const float p[3] = {point[3 * i], point[3 * i + 1], point[3 * i + 2]};
  float reachSquare = 3e38f;
  if (last != nullptr) {
    constexpr float kRounding = 1e-4f;
    const Float4 before = last[i];
    const float from[3] = {before.x, before.y, before.z};
    const float moved = __builtin_sqrtf(lumen::bench::squareOf(p, from));
    const float reach = (before.w + moved) * (1 + kRounding) + kRounding;
    reachSquare = reach * reach;
  }
  const Nearest found = nearestTriangle(nodes, corner, p, reachSquare);
  if (found.triangle < 0) {
    answer[i] = Float4{__builtin_sqrtf(reachSquare), 0, 0, 0};
    return;
  }
  const int64_t t = found.triangle;
  const Float4 a = corner[3 * t], b = corner[3 * t + 1], c = corner[3 * t + 2];
  const float pa[3] = {a.x, a.y, a.z}, pb[3] = {b.x, b.y, b.z}, pc[3] = {c.x, c.y, c.z};
  float q[3];
  const Feature feature = closestOnTriangle(p, pa, pb, pc, q);
  const Float4 pseudo = normal[7 * t + static_cast<int>(feature)];
  const float offset[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
  const float distance = __builtin_sqrtf(found.square);
  const float sign =
      offset[0] * pseudo.x + offset[1] * pseudo.y + offset[2] * pseudo.z < 0 ? -1.0f : 1.0f;
  const float scale = sign / distance;
  answer[i] = distance > 1e-6f
                  ? Float4{sign * distance, scale * offset[0], scale * offset[1], scale * offset[2]}
                  : Float4{sign * distance, pseudo.x, pseudo.y, pseudo.z};
  if (last != nullptr) last[i] = Float4{p[0], p[1], p[2], distance};
}

namespace {

__device__ float sample(uint64_t texture, float x, float y, float z) {
  float value, g, b, a;
  asm("tex.3d.v4.f32.f32 {%0, %1, %2, %3}, [%4, {%5, %6, %7, %7}];"
      : "=f"(value), "=f"(g), "=f"(b), "=f"(a)
      : "l"(texture), "f"(x), "f"(y), "f"(z));
  return value;
}

}  // namespace

// The same from a texture of distances: value (0, 0, 0) is at `low`, and cells have an edge of
// 1 / scale. The normal is the difference over half a cell to either side.
extern "C" __global__ void sample_grid(uint64_t texture, float lowX, float lowY, float lowZ,
                                       float scale, uint32_t count, const float* __restrict__ point,
                                       Float4* __restrict__ answer) {
  const uint32_t i = threadIndex();
  if (i >= count) return;
  const float x = (point[3 * i] - lowX) * scale + 0.5f,
              y = (point[3 * i + 1] - lowY) * scale + 0.5f,
              z = (point[3 * i + 2] - lowZ) * scale + 0.5f;
  const float distance = sample(texture, x, y, z);
  const float gx = sample(texture, x + 0.5f, y, z) - sample(texture, x - 0.5f, y, z);
  const float gy = sample(texture, x, y + 0.5f, z) - sample(texture, x, y - 0.5f, z);
  const float gz = sample(texture, x, y, z + 0.5f) - sample(texture, x, y, z - 0.5f);
  const float length = __builtin_sqrtf(gx * gx + gy * gy + gz * gz);
  const float inverse = length > 0 ? 1 / length : 0;
  answer[i] = Float4{distance, gx * inverse, gy * inverse, gz * inverse};
}
