/* SPDX-License-Identifier: Apache-2.0
 *
 * Part of blob_device.h: reads of the buffer on NVIDIA's processors, 16 bytes at a time, from an
 * address that is a multiple of 16. Nothing writes to the buffer meanwhile.
 */
#ifndef LUMEN_BLOB_DEVICE_LOAD_H
#define LUMEN_BLOB_DEVICE_LOAD_H

/* Copies four words. */
BLOB_DEVICE_FN void blob_device_read(blob_device_words from, blob_device_word* to) {
#if defined(__CUDA_ARCH__) && defined(__clang__)
  typedef blob_device_word vector __attribute__((ext_vector_type(4)));
  const vector read = __nvvm_ldg_ui4((const vector*)from);
#elif defined(__CUDA_ARCH__)
  const uint4 read = __ldg((const uint4*)from);
#else
  const struct { blob_device_word x, y, z, w; } read = {from[0], from[1], from[2], from[3]};
#endif
  to[0] = read.x;
  to[1] = read.y;
  to[2] = read.z;
  to[3] = read.w;
}

/* A node, and a place relative to its centre; as in blob_device_model.h, but that it has a copy of the
 * record, in registers. */
typedef struct blob_device_node {
  blob_device_word record[16];
  blob_device_words neighbour;
  blob_device_word blocks, rivals;
  float x[3];
} blob_device_node;

BLOB_DEVICE_FN blob_device_node blob_device_at(const blob_device_vessel* v, blob_device_word index,
                                               const blob_device_place* place) {
  blob_device_words record = v->words + v->nodes + BLOB_DEVICE_NODE_WORDS * index;
  blob_device_node node;
  float square;
  int i;
  BLOB_DEVICE_UNROLL
  for (i = 0; i < 16; i += 4) blob_device_read(record + i, node.record + i);
  BLOB_DEVICE_UNROLL
  for (i = 0; i < 3; ++i)
    node.x[i] = ((place->point[i] - blob_device_float(node.record[i])) -
                 blob_device_float(node.record[12 + i])) +
                place->step[i];
  square = (node.x[0] * node.x[0] + node.x[1] * node.x[1]) + node.x[2] * node.x[2];
  node.rivals = 0;
  node.blocks = node.record[11];
  if (node.blocks > 1 && square < blob_device_float(node.record[7])) node.blocks = 1;
  node.neighbour = v->words + v->neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS * node.record[10];
  return node;
}

#endif
