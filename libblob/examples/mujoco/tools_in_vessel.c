/* SPDX-License-Identifier: Apache-2.0 */
/* Drops a ball into a vessel and pushes a chain of capsules along it, for ten simulated seconds,
 * with gravity towards each of six directions. Reports how far they entered the wall and whether
 * they stayed in their vessel; exit code 1 if not. Units: mm, g, s. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vessel.h"

enum { kCapsules = 10, kSceneSize = 16384, kName = 32 };

static const double kSeconds = 10;
static const double kBall = 0.4, kCapsule = 0.2; /* radii, mm */

typedef struct scene {
  char text[kSceneSize];
  size_t size;
} scene;

static void put(scene* s, const char* text) {
  const size_t size = strlen(text);
  if (s->size + size >= sizeof s->text) abort();
  memcpy(s->text + s->size, text, size + 1);
  s->size += size;
}

/* The n-th descendant of a node by first children, or the last. */
static blob_node descend(const blob_model* vessel, uint32_t* node) {
  const size_t count = blob_model_describe(vessel).node_count;
  for (uint32_t i = 0; i < count; ++i)
    if (blob_model_node(vessel, i).parent == (int32_t)*node) {
      *node = i;
      break;
    }
  return blob_model_node(vessel, *node);
}

static void put_head(scene* s, const blob_model* vessel, const double gravity[3]) {
  const blob_model_info info = blob_model_describe(vessel);
  char line[1024];
  double centre[3], half[3];
  for (int a = 0; a < 3; ++a) {
    centre[a] = 0.5 * (info.low[a] + info.high[a]);
    half[a] = 0.5 * (info.high[a] - info.low[a]) + 5;
  }
  /* contacts react within 1 ms: small tools in full gravity would sink deep in the default 20 */
  snprintf(line, sizeof line,
           "<mujoco><size nconmax='200' njmax='1000'/>"
           "<option timestep='0.0005' gravity='%g %g %g' density='0.00106' viscosity='0.0035'/>"
           "<default><geom density='0.008' friction='0.1 0 0' solref='0.001 1' "
           "solimp='0.9 0.99 0.05'/><equality solref='0.001 1'/></default><worldbody>"
           "<geom name='vessel' type='box' pos='%g %g %g' size='%g %g %g' rgba='1 0 0 0.1'/>",
           9810 * gravity[0], 9810 * gravity[1], 9810 * gravity[2], centre[0], centre[1], centre[2],
           half[0], half[1], half[2]);
  put(s, line);
}

/* Adds a free capsule for each step along the centerline, joined end to end, and the ball ahead. */
static void put_tools(scene* s, const blob_model* vessel, uint32_t node) {
  char line[512];
  blob_node from = blob_model_node(vessel, node);
  double length[kCapsules];
  int count = 0;
  for (; count < kCapsules; ++count) {
    const blob_node to = descend(vessel, &node);
    const double* a = from.centre;
    const double* b = to.centre;
    length[count] = hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
    if (length[count] < 0.1) break;
    snprintf(line, sizeof line,
             "<body name='c%d' pos='%.9g %.9g %.9g'><freejoint/>"
             "<geom type='capsule' contype='2' size='%g' fromto='0 0 0 %.9g %.9g %.9g'/></body>",
             count, a[0], a[1], a[2], kCapsule, b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    put(s, line);
    from = to;
  }
  for (int skip = 0; skip < 4; ++skip) from = descend(vessel, &node);
  snprintf(line, sizeof line,
           "<body name='ball' pos='%.9g %.9g %.9g'><freejoint/>"
           "<geom type='sphere' contype='2' size='%g'/></body></worldbody><equality>",
           from.centre[0], from.centre[1], from.centre[2], kBall);
  put(s, line);
  for (int i = 1; i < count; ++i) {
    snprintf(line, sizeof line, "<connect body1='c%d' body2='c%d' anchor='0 0 0'/>", i, i - 1);
    put(s, line);
  }
  put(s, "</equality></mujoco>");
}

static mjModel* build(const blob_model* vessel, uint32_t node, const double gravity[3]) {
  static mjVFS files;
  scene* s = calloc(1, sizeof *s);
  char error[500] = "out of memory";
  mjModel* m = NULL;
  if (s != NULL) {
    put_head(s, vessel, gravity);
    put_tools(s, vessel, node);
    mj_defaultVFS(&files);
    if (mj_makeEmptyFileVFS(&files, "scene.xml", (int)s->size) == 0) {
      memcpy(files.filedata[files.nfile - 1], s->text, s->size);
      m = mj_loadXML("scene.xml", &files, error, sizeof error);
    }
    mj_deleteVFS(&files);
  }
  if (m == NULL) fprintf(stderr, "tools_in_vessel: %s\n", error);
  free(s);
  return m;
}

static uint32_t root_of(const blob_model* vessel, uint32_t node) {
  int32_t parent;
  while ((parent = blob_model_node(vessel, node).parent) >= 0) node = (uint32_t)parent;
  return node;
}

typedef struct outcome {
  double deepest;      /* mm of a tool's surface beyond the wall */
  double travel;       /* mm from start to end, greatest of all tools */
  int left, crossings; /* tools' centres outside; steps at which a tool was in another tree */
} outcome;

static void watch(const mjModel* m, const mjData* d, const blob_model* vessel, uint32_t root,
                  outcome* o) {
  for (int g = 1; g < m->ngeom; ++g) {
    uint32_t cursor = vessel_node(g);
    if (cursor == BLOB_NOWHERE) continue;
    o->crossings += root_of(vessel, cursor) != root;
    blob_sample s;
    blob_query(vessel, 0, d->geom_xpos + 3 * g, &cursor, &s);
    o->left += (s.state & BLOB_INSIDE) == 0;
    const double depth = s.distance + m->geom_size[3 * g];
    if (!(depth <= o->deepest)) o->deepest = depth;
  }
}

/* Pushes the base along its own axis towards a speed of 20 mm/s, with at most four times the
 * chain's weight. */
static void push(const mjModel* m, mjData* d) {
  const int body = mj_name2id(m, mjOBJ_BODY, "c0");
  const mjtNum *frame = d->geom_xmat + 9 * m->body_geomadr[body],
               weight = m->body_mass[body] * 9810;
  const mjtNum axis[3] = {frame[2], frame[5], frame[8]};
  const mjtNum speed = mju_dot3(d->qvel + m->body_dofadr[body], axis);
  const mjtNum force = weight * fmin(4 * kCapsules, fmax(0, 0.5 * kCapsules * (20 - speed)));
  mju_scl3(d->xfrc_applied + 6 * body, axis, force);
}

static outcome simulate(const mjModel* m, const blob_model* vessel, uint32_t root) {
  outcome o = {.deepest = -INFINITY};
  mjData* d = mj_makeData(m);
  mj_forward(m, d);
  mjtNum* start = malloc(3 * (size_t)m->ngeom * sizeof *start);
  memcpy(start, d->geom_xpos, 3 * (size_t)m->ngeom * sizeof *start);
  while (d->time < kSeconds) {
    push(m, d);
    mj_step(m, d);
    watch(m, d, vessel, root, &o);
  }
  for (int g = 1; g < m->ngeom; ++g)
    o.travel = fmax(o.travel, mju_dist3(start + 3 * g, d->geom_xpos + 3 * g));
  if (d->warning[mjWARN_BADQACC].number + d->warning[mjWARN_BADQPOS].number > 0) o.left = 1;
  free(start);
  mj_deleteData(d);
  return o;
}

static int run(const blob_model* vessel, uint32_t root, int sides) {
  int good = 1;
  for (int side = 0; side < sides; ++side) {
    double gravity[3] = {0, 0, 0};
    gravity[side % 3] = side < 3 ? -1 : 1;
    mjModel* m = build(vessel, root, gravity);
    if (m == NULL || !vessel_attach(m, "vessel", vessel, 1)) return 1;
    const outcome o = simulate(m, vessel, root);
    printf(
        "root %u, gravity %+g %+g %+g: deepest %.4f mm in the wall, travelled %.2f mm, "
        "outside %d, in another vessel %d\n",
        root, gravity[0], gravity[1], gravity[2], o.deepest, o.travel, o.left, o.crossings);
    good = good && o.left == 0 && o.crossings == 0;
    vessel_detach();
    mj_deleteModel(m);
  }
  return good ? 0 : 1;
}

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    fputs(
        "Usage: tools_in_vessel MODEL.lumen [SIDES]\n"
        "SIDES 1 to 6: gravity towards -x, -y, -z, +x, +y, +z; all by default.\n",
        stderr);
    return 2;
  }
  blob_model* vessel = NULL;
  const blob_status status = blob_model_open(argv[1], NULL, &vessel);
  if (status != BLOB_OK) {
    fprintf(stderr, "tools_in_vessel: %s: %s\n", argv[1], blob_status_text(status));
    return 1;
  }
  const int sides = argc == 3 ? atoi(argv[2]) : 6;
  const size_t count = blob_model_describe(vessel).node_count;
  int failed = 0;
  for (uint32_t i = 0; i < count; ++i)
    if (blob_model_node(vessel, i).parent < 0) failed |= run(vessel, i, sides < 6 ? sides : 6);
  blob_model_close(vessel);
  return failed;
}
