// SPDX-License-Identifier: Apache-2.0
// blob_query_columns() as a kernel of OpenCL C 1.2. Any number of work items shares the points: on a
// graphics processor one for each point, on any other a few for each core. Build it with the folder
// of blob_device.h as include path.
#include "blob_device.h"

// `point`: x, y, z of each point, mm. Cursors are read and moved. `answer`: distance in mm and
// outward normal of each point, in four floats; `value`: f and its gradient, if wanted.
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
    answer[4 * i] = sample.distance;
    for (int k = 0; k < 3; ++k) answer[4 * i + 1 + k] = sample.normal[k];
    if (state) state[i] = sample.state;
    if (!value) continue;
    value[4 * i] = sample.value;
    for (int k = 0; k < 3; ++k) value[4 * i + 1 + k] = sample.gradient[k];
  }
}
