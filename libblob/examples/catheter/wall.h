/* SPDX-License-Identifier: Apache-2.0 */
/* Interface between a rod and the wall around it, for any representation of the wall. */
#ifndef CATHETER_WALL_H
#define CATHETER_WALL_H

#include <stddef.h>
#include <stdint.h>

#include "blob.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Points at a wall, in order along the rod, and the forces there. */
typedef struct wall_load {
  size_t count;
  const double (*points)[3];  /* mm */
  const double (*normals)[3]; /* outward unit vectors */
  const double (*forces)[3];  /* on the wall, N; 0 where nothing touches */
  const uint32_t* cursors;    /* those of query() */
} wall_load;

typedef struct wall {
  void* self;
  /* For `count` points (mm): the signed distance to the wall, negative in the lumen, and the
   * outward unit normal there. `cursors` holds one number for each point, kept from call to call,
   * that begins as start_cursor: the point's node, or its last triangle. */
  void (*query)(void* self, size_t count, const double (*points)[3], uint32_t* cursors,
                double* distances, double (*normals)[3]);
  void (*close)(void* self);
  /* Null for a rigid wall. Otherwise forces on the wall move it to where it is at the end of the
   * time step; see wall_load. `first` is 1 at the first call of a step. `yields` gets, for each
   * point, a bound of how far the wall gives way there along its normal when the forces at all
   * points near it grow by 1 N, mm/N. */
  void (*press)(void* self, int first, const wall_load* load, double* yields);
  uint32_t start_cursor;
  size_t primitives; /* blobs or triangles */
} wall;

/* The wall of a model, which must outlive it. `flags` are those of blob_query(); `start` is the
 * node that points begin at. */
wall wall_of_model(const blob_model* model, uint32_t flags, uint32_t start);

/* The query of a wall by a model, for walls that wrap one. */
void wall_query_model(const blob_model* model, uint32_t flags, size_t count,
                      const double (*points)[3], uint32_t* cursors, double* distances,
                      double (*normals)[3]);

/* The wall of a triangle mesh, by Embree's closest point. Farther than `reach` mm from it the
 * distance is -reach: nothing touches. Triangles face outwards. The arrays are copied. self is null
 * if memory ran out. */
wall wall_of_mesh(size_t vertex_count, const float (*vertices)[3], size_t triangle_count,
                  const uint32_t (*triangles)[3], double reach);

/* The wall of a triangle mesh from the v and f lines of a Wavefront OBJ file, as by wall_of_mesh();
 * self is null if the file cannot be read. */
wall wall_of_obj(const char* path, double reach);

#ifdef __cplusplus
}
#endif
#endif
