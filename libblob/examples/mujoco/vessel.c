/* SPDX-License-Identifier: Apache-2.0 */
#include "vessel.h"

#include <stdlib.h>

static struct {
  const blob_model* blobs;
  int geom, body;
  double unit;
  int cursor_count;
  uint32_t (*cursors)[2]; /* of each geom: a sphere's centre, or a capsule's ends */
  mjfCollision sphere_box, capsule_box;
} g_vessel;

/* A point of the world in the vessel's frame, mm. */
static void to_vessel(const mjData* d, const mjtNum world[3], double point[3]) {
  mjtNum away[3], local[3];
  mju_sub3(away, world, d->xpos + 3 * g_vessel.body);
  mju_rotVecMatT(local, away, d->xmat + 9 * g_vessel.body);
  for (int a = 0; a < 3; ++a) point[a] = local[a] / g_vessel.unit;
}

/* Fills a contact of a ball with the wall that is `distance` (mm, negative in the lumen) from its
 * centre. MuJoCo's normal points from the first geom, the tool, to the second, the wall. */
static int fill_contact(const mjData* d, mjContact* contact, const mjtNum centre[3], mjtNum radius,
                        double distance, const double normal[3], mjtNum margin) {
  const mjtNum gap = -distance * g_vessel.unit - radius;
  if (!(gap <= margin)) return 0; /* nor if the tool is at no place */
  mju_rotVecMat(contact->frame, normal, d->xmat + 9 * g_vessel.body);
  mju_zero3(contact->frame + 3);
  mju_addScl3(contact->pos, centre, contact->frame, radius + 0.5 * gap);
  contact->dist = gap;
  return 1;
}

static int collide_ball(const mjData* d, mjContact* contact, const mjtNum centre[3], mjtNum radius,
                        uint32_t* cursor, mjtNum margin) {
  double point[3];
  blob_sample s;
  to_vessel(d, centre, point);
  blob_query(g_vessel.blobs, BLOB_BLENDED, point, cursor, &s);
  return fill_contact(d, contact, centre, radius, s.distance, s.normal, margin);
}

static int sphere_vessel(const mjModel* m, const mjData* d, mjContact* contact, int g1, int g2,
                         mjtNum margin) {
  if (g2 != g_vessel.geom || g1 >= g_vessel.cursor_count)
    return g_vessel.sphere_box(m, d, contact, g1, g2, margin);
  return collide_ball(d, contact, d->geom_xpos + 3 * g1, m->geom_size[3 * g1],
                      &g_vessel.cursors[g1][0], margin);
}

/* Both ends keep a capsule from turning through the wall; its deepest point between them keeps a
 * bend of the wall from entering its side. */
static int capsule_vessel(const mjModel* m, const mjData* d, mjContact* contact, int g1, int g2,
                          mjtNum margin) {
  if (g2 != g_vessel.geom || g1 >= g_vessel.cursor_count)
    return g_vessel.capsule_box(m, d, contact, g1, g2, margin);
  const mjtNum *centre = d->geom_xpos + 3 * g1, *frame = d->geom_xmat + 9 * g1;
  const mjtNum radius = m->geom_size[3 * g1], half = m->geom_size[3 * g1 + 1];
  const mjtNum axis[3] = {frame[2], frame[5], frame[8]};
  mjtNum end[2][3];
  int count = 0;
  for (int k = 0; k < 2; ++k) {
    mju_addScl3(end[k], centre, axis, k == 0 ? -half : half);
    count += collide_ball(d, contact + count, end[k], radius, &g_vessel.cursors[g1][k], margin);
  }
  double from[3], to[3];
  to_vessel(d, end[0], from);
  to_vessel(d, end[1], to);
  uint32_t cursor = g_vessel.cursors[g1][0];
  blob_approach deepest;
  blob_capsule_approach(g_vessel.blobs, BLOB_BLENDED, from, to, radius / g_vessel.unit, &cursor,
                        &deepest);
  if (deepest.t < 0.05 || deepest.t > 0.95) return count; /* an end has it */
  mjtNum point[3];
  mju_addScl3(point, end[0], axis, 2 * half * deepest.t);
  return count +
         fill_contact(d, contact + count, point, radius, deepest.distance, deepest.normal, margin);
}

int vessel_attach(const mjModel* m, const char* name, const blob_model* blobs, double unit) {
  vessel_detach();
  const int geom = mj_name2id(m, mjOBJ_GEOM, name);
  if (geom < 0 || m->geom_type[geom] != mjGEOM_BOX) return 0;
  const size_t size = (size_t)m->ngeom;
  g_vessel.cursors = malloc(size * sizeof g_vessel.cursors[0]);
  if (g_vessel.cursors == NULL) return 0;
  for (size_t i = 0; i < size; ++i) g_vessel.cursors[i][0] = g_vessel.cursors[i][1] = BLOB_NOWHERE;
  g_vessel.cursor_count = m->ngeom;
  g_vessel.blobs = blobs;
  g_vessel.geom = geom;
  g_vessel.body = m->geom_bodyid[geom];
  g_vessel.unit = unit;
  g_vessel.sphere_box = mjCOLLISIONFUNC[mjGEOM_SPHERE][mjGEOM_BOX];
  g_vessel.capsule_box = mjCOLLISIONFUNC[mjGEOM_CAPSULE][mjGEOM_BOX];
  mjCOLLISIONFUNC[mjGEOM_SPHERE][mjGEOM_BOX] = sphere_vessel;
  mjCOLLISIONFUNC[mjGEOM_CAPSULE][mjGEOM_BOX] = capsule_vessel;
  return 1;
}

void vessel_detach(void) {
  if (g_vessel.cursors == NULL) return;
  mjCOLLISIONFUNC[mjGEOM_SPHERE][mjGEOM_BOX] = g_vessel.sphere_box;
  mjCOLLISIONFUNC[mjGEOM_CAPSULE][mjGEOM_BOX] = g_vessel.capsule_box;
  free(g_vessel.cursors);
  g_vessel.cursors = NULL;
  g_vessel.cursor_count = 0;
}

uint32_t vessel_node(int geom) {
  return geom >= 0 && geom < g_vessel.cursor_count ? g_vessel.cursors[geom][0] : BLOB_NOWHERE;
}
