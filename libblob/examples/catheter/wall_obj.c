/* SPDX-License-Identifier: Apache-2.0 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "wall.h"

typedef struct mesh_arrays {
  float (*vertices)[3];
  uint32_t (*triangles)[3];
  size_t vertex_count, triangle_count;
  size_t vertex_room, triangle_room;
} mesh_arrays;

/* Makes room for one more item of `size` bytes; returns 0 if memory ran out. */
static int grow(void** items, size_t count, size_t* room, size_t size) {
  if (count < *room) return 1;
  const size_t more = *room == 0 ? 1024 : 2 * *room;
  void* moved = realloc(*items, more * size);
  if (moved == NULL) return 0;
  *items = moved;
  *room = more;
  return 1;
}

static int read_vertex(const char* line, mesh_arrays* m) {
  void* items = m->vertices;
  if (!grow(&items, m->vertex_count, &m->vertex_room, sizeof m->vertices[0])) return 0;
  m->vertices = items;
  float* v = m->vertices[m->vertex_count++];
  return sscanf(line, "v %f %f %f", &v[0], &v[1], &v[2]) == 3;
}

/* Reads the position indices of a line such as "f 1/1/1 2/2/2 3/3/3", which count from one. */
static int read_face(const char* line, mesh_arrays* m) {
  void* items = m->triangles;
  if (!grow(&items, m->triangle_count, &m->triangle_room, sizeof m->triangles[0])) return 0;
  m->triangles = items;
  uint32_t* t = m->triangles[m->triangle_count++];
  const char* at = line + 1;
  for (int k = 0; k < 3; ++k) {
    char* end;
    const unsigned long index = strtoul(at, &end, 10);
    if (end == at || index == 0 || index > m->vertex_count) return 0;
    t[k] = (uint32_t)(index - 1);
    at = end + strcspn(end, " \t\r\n");
  }
  return 1;
}

static int read_obj(FILE* file, mesh_arrays* m) {
  char line[512];
  int good = 1;
  while (good && fgets(line, sizeof line, file) != NULL) {
    if (strncmp(line, "v ", 2) == 0) good = read_vertex(line, m);
    if (strncmp(line, "f ", 2) == 0) good = read_face(line, m);
  }
  return good && m->triangle_count > 0;
}

wall wall_of_obj(const char* path, double reach) {
  wall w = {0};
  mesh_arrays m = {0};
  FILE* file = fopen(path, "r");
  if (file == NULL) return w;
  if (read_obj(file, &m))
    w = wall_of_mesh(m.vertex_count, (const float(*)[3])m.vertices, m.triangle_count,
                     (const uint32_t(*)[3])m.triangles, reach);
  fclose(file);
  free(m.vertices);
  free(m.triangles);
  return w;
}
