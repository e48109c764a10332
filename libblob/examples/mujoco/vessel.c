/* SPDX-License-Identifier: Apache-2.0 */
#include "vessel.h"

#include <stdlib.h>

#include "wall.h"

static struct {
  wall wall;
  int geom, body;
  int cursor_count;
  uint32_t (*cursors)[2]; /* for each geom: a sphere's centre, or a capsule's ends */
  mjfCollision sphere_box, capsule_box;
} g_vessel;

/* Converts a point of the world to the vessel's frame. */
static void to_vessel(const mjData* d, const mjtNum world[3], double point[3]) {
  mjtNum away[3];
  mju_sub3(away, world, d->xpos + 3 * g_vessel.body);
  mju_rotVecMatT(point, away, d->xmat + 9 * g_vessel.body);
}

/* Fills a contact of a ball with the wall. MuJoCo's normal points from the first geom, the tool, to
 * the second, the wall. */
static int fill_contact(const mjData* d, mjContact* contact, const mjtNum centre[3], mjtNum radius,
                        const wall_answer* at_centre, mjtNum margin) {
  const mjtNum gap = at_centre->gap - radius;
  if (!(gap <= margin)) return 0; /* also for a NaN: a tool at no place */
  mju_rotVecMat(contact->frame, at_centre->normal, d->xmat + 9 * g_vessel.body);
  mju_zero3(contact->frame + 3);
  mju_addScl3(contact->pos, centre, contact->frame, radius + 0.5 * gap);
  contact->dist = gap;
  return 1;
}

static int collide_ball(const mjData* d, mjContact* contact, const mjtNum centre[3], mjtNum radius,
                        uint32_t* cursor, mjtNum margin) {
  double point[3];
  to_vessel(d, centre, point);
  const wall_answer at_centre = wall_at(&g_vessel.wall, point, cursor);
  return fill_contact(d, contact, centre, radius, &at_centre, margin);
}

static int sphere_vessel(const mjModel* m, const mjData* d, mjContact* contact, int g1, int g2,
                         mjtNum margin) {
  if (g2 != g_vessel.geom || g1 >= g_vessel.cursor_count)
    return g_vessel.sphere_box(m, d, contact, g1, g2, margin);
  return collide_ball(d, contact, d->geom_xpos + 3 * g1, m->geom_size[3 * g1],
                      &g_vessel.cursors[g1][0], margin);
}

/* Fills the contacts of a capsule: both ends keep it from turning through the wall; the deepest
 * point between them keeps a bend of the wall from entering its side. */
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
  wall_answer deepest;
  const double t =
      wall_deepest(&g_vessel.wall, from, to, radius, g_vessel.cursors[g1][0], &deepest);
  if (t < 0.05 || t > 0.95) return count; /* an end has this contact */
  mjtNum point[3];
  mju_addScl3(point, end[0], axis, 2 * half * t);
  return count + fill_contact(d, contact + count, point, radius, &deepest, margin);
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
  g_vessel.wall.blobs = blobs;
  g_vessel.wall.unit = unit;
  g_vessel.geom = geom;
  g_vessel.body = m->geom_bodyid[geom];
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
