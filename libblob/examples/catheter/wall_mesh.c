/* SPDX-License-Identifier: Apache-2.0 */
#include <embree3/rtcore.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "wall.h"

typedef struct mesh_wall {
  RTCDevice device;
  RTCScene scene;
  const float (*vertices)[3]; /* Embree's buffers */
  const uint32_t (*triangles)[3];
  size_t triangle_count;
  double reach;
} mesh_wall;

typedef struct nearest_triangle {
  const mesh_wall* mesh;
  uint32_t triangle;
  double point[3]; /* nearest to the query point in the triangle */
  double squared;  /* distance, mm^2 */
} nearest_triangle;

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void along(const double a[3], const double u[3], double s, double result[3]) {
  for (int i = 0; i < 3; ++i) result[i] = a[i] + s * u[i];
}

static void corners(const mesh_wall* mesh, uint32_t triangle, double corner[3][3]) {
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      corner[k][i] = (double)mesh->vertices[mesh->triangles[triangle][k]][i];
}

/* Nearest point of a triangle by the Voronoi regions of its corners, edges and face (C. Ericson,
 * Real-Time Collision Detection, 2005, section 5.1.5). */
static void nearest_on_triangle(const double p[3], double c[3][3], double nearest[3]) {
  double ab[3], ac[3], bc[3], ap[3], bp[3], cp[3];
  for (int i = 0; i < 3; ++i) {
    ab[i] = c[1][i] - c[0][i];
    ac[i] = c[2][i] - c[0][i];
    bc[i] = c[2][i] - c[1][i];
    ap[i] = p[i] - c[0][i];
    bp[i] = p[i] - c[1][i];
    cp[i] = p[i] - c[2][i];
  }
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp);
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (d1 <= 0 && d2 <= 0)
    along(c[0], ab, 0, nearest);
  else if (d3 >= 0 && d4 <= d3)
    along(c[1], ab, 0, nearest);
  else if (d6 >= 0 && d5 <= d6)
    along(c[2], ab, 0, nearest);
  else if (vc <= 0 && d1 >= 0 && d3 <= 0)
    along(c[0], ab, d1 / (d1 - d3), nearest);
  else if (vb <= 0 && d2 >= 0 && d6 <= 0)
    along(c[0], ac, d2 / (d2 - d6), nearest);
  else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    along(c[1], bc, (d4 - d3) / ((d4 - d3) + (d5 - d6)), nearest);
  else {
    along(c[0], ab, vb / (va + vb + vc), nearest);
    along(nearest, ac, vc / (va + vb + vc), nearest);
  }
}

/* Keeps the triangle if it is nearer than the best so far. */
static int consider(nearest_triangle* best, uint32_t triangle, const double p[3]) {
  double corner[3][3], q[3];
  corners(best->mesh, triangle, corner);
  nearest_on_triangle(p, corner, q);
  double away[3];
  along(p, q, -1, away);
  const double squared = dot(away, away);
  if (squared >= best->squared) return 0;
  best->squared = squared;
  best->triangle = triangle;
  memcpy(best->point, q, sizeof q);
  return 1;
}

typedef struct query_state {
  nearest_triangle best;
  double point[3];
} query_state;

static bool visit(struct RTCPointQueryFunctionArguments* args) {
  query_state* state = args->userPtr;
  if (!consider(&state->best, args->primID, state->point)) return false;
  args->query->radius = (float)sqrt(state->best.squared);
  return true;
}

/* The signed distance: the side that the nearest triangle faces decides inside or outside. The
 * normal is the direction to the nearest point, which turns from one face's normal to the other's
 * at an edge; on the surface it is the face's normal. */
static double signed_answer(const nearest_triangle* best, const double p[3], double normal[3]) {
  double c[3][3], ab[3], ac[3], face[3], away[3];
  corners(best->mesh, best->triangle, c);
  along(c[1], c[0], -1, ab);
  along(c[2], c[0], -1, ac);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    face[i] = ab[j] * ac[k] - ab[k] * ac[j];
  }
  along(p, best->point, -1, away);
  const double sign = dot(away, face) > 0 ? 1 : -1;
  const double distance = sqrt(best->squared), length = sqrt(dot(face, face));
  for (int i = 0; i < 3; ++i)
    normal[i] = distance > 1e-6 ? sign * away[i] / distance : face[i] / length;
  return sign * distance;
}

static void query_mesh(void* self, size_t count, const double (*points)[3], uint32_t* cursors,
                       double* distances, double (*normals)[3]) {
  const mesh_wall* mesh = self;
  struct RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  for (size_t i = 0; i < count; ++i) {
    const double* p = points[i];
    query_state state = {{mesh, UINT32_MAX, {0, 0, 0}, mesh->reach * mesh->reach},
                         {p[0], p[1], p[2]}};
    /* the triangle of the last call bounds the search tightly */
    if (cursors[i] < mesh->triangle_count) consider(&state.best, cursors[i], p);
    struct RTCPointQuery query = {(float)p[0], (float)p[1], (float)p[2], 0,
                                  (float)sqrt(state.best.squared)};
    rtcPointQuery(mesh->scene, &query, &context, visit, &state);
    if (state.best.triangle == UINT32_MAX) {
      distances[i] = -mesh->reach;
      memset(normals[i], 0, sizeof normals[i]);
      continue;
    }
    cursors[i] = state.best.triangle;
    distances[i] = signed_answer(&state.best, p, normals[i]);
  }
}

static void close_mesh(void* self) {
  mesh_wall* mesh = self;
  if (mesh == NULL) return;
  rtcReleaseScene(mesh->scene);
  rtcReleaseDevice(mesh->device);
  free(mesh);
}

wall wall_of_mesh(size_t vertex_count, const float (*vertices)[3], size_t triangle_count,
                  const uint32_t (*triangles)[3], double reach) {
  wall w = {NULL, query_mesh, close_mesh, NULL, UINT32_MAX, triangle_count};
  mesh_wall* mesh = malloc(sizeof *mesh);
  if (mesh == NULL) return w;
  mesh->device = rtcNewDevice("threads=1");
  mesh->scene = rtcNewScene(mesh->device);
  rtcSetSceneBuildQuality(mesh->scene, RTC_BUILD_QUALITY_HIGH);
  RTCGeometry geometry = rtcNewGeometry(mesh->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* v = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof vertices[0], vertex_count);
  void* t = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    sizeof triangles[0], triangle_count);
  mesh->vertices = v;
  mesh->triangles = t;
  mesh->triangle_count = triangle_count;
  mesh->reach = reach;
  if (v != NULL && t != NULL) {
    memcpy(v, vertices, vertex_count * sizeof vertices[0]);
    memcpy(t, triangles, triangle_count * sizeof triangles[0]);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(mesh->scene, geometry);
    rtcCommitScene(mesh->scene);
    w.self = mesh;
  }
  rtcReleaseGeometry(geometry);
  if (w.self == NULL) close_mesh(mesh);
  return w;
}
