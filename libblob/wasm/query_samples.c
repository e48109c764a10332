/* SPDX-License-Identifier: Apache-2.0 */
/* Writes the native library's answers for compare.mjs: query_samples MODEL.lumen COUNT OUT. Points
 * are random around the nodes, out to three radii, each fourth of them anywhere in the model's box;
 * flags take turns. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "blob.h"

enum {
  kNumbers = 14
}; /* flags, point, value, gradient, distance, normal, node, state; all as doubles */

/* splitmix64 (S. Vigna, 2015), as a number in [0, 1). */
static double next_share(uint64_t* state) {
  uint64_t z = *state += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static void random_point(const blob_model* model, const blob_model_info* info, size_t i,
                         uint64_t* state, double point[3]) {
  const blob_node node =
      blob_model_node(model, (uint32_t)(next_share(state) * (double)info->node_count));
  for (int a = 0; a < 3; ++a) {
    const double share = next_share(state);
    point[a] = i % 4 == 3 ? info->low[a] + share * (info->high[a] - info->low[a])
                          : node.centre[a] + node.radius * (6 * share - 3) / sqrt(3);
  }
}

int main(int argc, char** argv) {
  static const uint32_t flags[] = {BLOB_BLENDED, BLOB_LOCAL, BLOB_DISTANCE_EXACT, BLOB_BLENDED};
  blob_model* model = NULL;
  FILE* file = argc == 4 ? fopen(argv[3], "wb") : NULL;
  if (file == NULL || blob_model_open(argv[1], NULL, &model) != BLOB_OK) {
    fputs("Usage: query_samples MODEL.lumen COUNT OUT\n", stderr);
    return 1;
  }
  const blob_model_info info = blob_model_describe(model);
  uint64_t state = 1;
  int good = 1;
  for (size_t i = 0; good && i < strtoul(argv[2], NULL, 10); ++i) {
    double row[kNumbers];
    blob_sample s;
    row[0] = flags[i % 4];
    random_point(model, &info, i, &state, row + 1);
    blob_query(model, flags[i % 4], row + 1, NULL, &s);
    row[4] = s.value;
    row[8] = s.distance;
    for (int a = 0; a < 3; ++a) {
      row[5 + a] = s.gradient[a];
      row[9 + a] = s.normal[a];
    }
    row[12] = s.node;
    row[13] = s.state;
    good = fwrite(row, sizeof row, 1, file) == 1;
  }
  blob_model_close(model);
  return fclose(file) == 0 && good ? 0 : 1;
}
