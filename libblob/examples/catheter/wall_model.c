/* SPDX-License-Identifier: Apache-2.0 */
#include <stdlib.h>

#include "wall.h"

typedef struct model_wall {
  const blob_model* model;
  uint32_t flags;
} model_wall;

enum { kBatch = 64 }; /* samples that stay in the cache between the query and the copy */

void wall_query_model(const blob_model* model, uint32_t flags, size_t count,
                      const double (*points)[3], uint32_t* cursors, double* distances,
                      double (*normals)[3]) {
  blob_sample samples[kBatch];
  for (size_t first = 0; first < count; first += kBatch) {
    const size_t size = count - first < kBatch ? count - first : kBatch;
    blob_query_many(model, flags, size, points + first, cursors + first, samples);
    for (size_t k = 0; k < size; ++k) {
      distances[first + k] = samples[k].distance;
      for (int a = 0; a < 3; ++a) normals[first + k][a] = samples[k].normal[a];
    }
  }
}

static void query_model(void* self, size_t count, const double (*points)[3], uint32_t* cursors,
                        double* distances, double (*normals)[3]) {
  const model_wall* m = self;
  wall_query_model(m->model, m->flags, count, points, cursors, distances, normals);
}

wall wall_of_model(const blob_model* model, uint32_t flags, uint32_t start) {
  wall w = {NULL, query_model, free, NULL, start, blob_model_describe(model).blob_count};
  model_wall* m = malloc(sizeof *m);
  if (m != NULL) {
    m->model = model;
    m->flags = flags;
  }
  w.self = m;
  return w;
}
