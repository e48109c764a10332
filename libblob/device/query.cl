// SPDX-License-Identifier: Apache-2.0
// blob_query_columns() as a kernel of OpenCL C 1.2. Any number of work items shares the points: on a
// graphics processor one for each point, on any other a few for each core. Build it with the folder
// of blob_device.h as include path.
#include "blob_device_exact.h"
#if BLOB_DEVICE_WIDE
#include "blob_device_batch.h"
#endif

static inline void write_answer(const blob_device_sample* sample, size_t i, __global float* answer,
                                __global float* value, __global uint* state) {
  answer[4 * i] = sample->distance;
  for (int k = 0; k < 3; ++k) answer[4 * i + 1 + k] = sample->normal[k];
  if (state) state[i] = sample->state;
  if (!value) return;
  value[4 * i] = sample->value;
  for (int k = 0; k < 3; ++k) value[4 * i + 1 + k] = sample->gradient[k];
}

// `point`: x, y, z of each point, mm. Cursors are read and moved. `answer`: distance in mm and
// outward normal of each point, in four floats; `value`: f and its gradient, if wanted.
#if BLOB_DEVICE_WIDE
// A work item takes points that follow one another, as they share what a processor's caches hold.
__kernel void blob_query_points(__global const uint* words, uint vessel, uint flags, uint count,
                                __global const float* point, __global uint* cursor,
                                __global float* answer, __global float* value,
                                __global uint* state) {
  const blob_device_vessel v = blob_device_open(words, vessel);
  const size_t items = get_global_size(0), groups = ((size_t)count + 7) / 8;
  const size_t share = (groups + items - 1) / items * 8, start = share * get_global_id(0);
  const size_t end = min(start + share, (size_t)count);
  for (size_t first = start; first < end; first += 8) {
    const int together = (int)min((size_t)8, end - first);
    blob_device_group g;
    for (int k = 0; k < together; ++k) {
      for (int axis = 0; axis < 3; ++axis) g.point[k][axis] = point[3 * (first + k) + axis];
      g.node[k] = cursor[first + k];
    }
    blob_device_query_group(&v, flags, together, &g);
    for (int k = 0; k < together; ++k) {
      const size_t i = first + k;
      cursor[i] = g.node[k];
      answer[4 * i] = g.distance[k];
      for (int axis = 0; axis < 3; ++axis) answer[4 * i + 1 + axis] = g.normal[axis][k];
      if (state) state[i] = g.state[k];
      if (!value) continue;
      for (int row = 0; row < 4; ++row) value[4 * i + row] = g.field[row][k];
    }
  }
}
#else
__kernel void blob_query_points(__global const uint* words, uint vessel, uint flags, uint count,
                                __global const float* point, __global uint* cursor,
                                __global float* answer, __global float* value,
                                __global uint* state) {
  for (size_t i = get_global_id(0); i < count; i += get_global_size(0)) {
    const float at[3] = {point[3 * i], point[3 * i + 1], point[3 * i + 2]};
    uint node = cursor[i];
    blob_device_sample sample;
    blob_device_query(words, vessel, flags, at, &node, &sample);
    cursor[i] = node;
    write_answer(&sample, i, answer, value, state);
  }
}
#endif

// The same with the distance to the nearest point of the wall and the normal there, as for
// BLOB_DISTANCE_EXACT; `state` may have BLOB_DEVICE_NOT_CONVERGED.
__kernel void blob_query_exact_points(__global const uint* words, uint vessel, uint flags,
                                      uint count, __global const float* point,
                                      __global uint* cursor, __global float* answer,
                                      __global float* value, __global uint* state) {
  for (size_t i = get_global_id(0); i < count; i += get_global_size(0)) {
    const float at[3] = {point[3 * i], point[3 * i + 1], point[3 * i + 2]};
    uint node = cursor[i];
    blob_device_sample sample;
    blob_device_query_exact(words, vessel, flags, at, &node, &sample);
    cursor[i] = node;
    write_answer(&sample, i, answer, value, state);
  }
}
