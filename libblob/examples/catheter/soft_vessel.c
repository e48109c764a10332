/* SPDX-License-Identifier: Apache-2.0 */
#include "soft_vessel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double kPi = 3.14159265358979324;
static const double kUnseen = 1e-5; /* mm; the model does not follow a node that moves less */
enum { kWeights = 24 };             /* as many nodes as answer at a point */

/* Memory that every step reuses. */
typedef struct scratch {
  double (*before)[kBlock];   /* `moved` before the step */
  double (*velocity)[kBlock]; /* before the step */
  double (*mass)[kBlock];     /* t and t mm^2 */
  double (*load)[kBlock];     /* N and N mm; then the solution */
  double (*posed)[kBlock];    /* `moved` as the pose has it */
  block* compliance;          /* of each node within a step */
  double* decay;              /* 1/mm, with which it fades along the vessel */
  unsigned char* awake;       /* 1: a node that moves; others rest, in subtrees */
  uint32_t* moving;           /* those nodes, parents first */
  size_t moving_count;
  int woken;       /* 1: `moving` lacks a node */
  uint32_t* nodes; /* nodes that are set */
  blob_transform* transforms;
} scratch;

static void cross(const double a[3], const double b[3], double c[3]) {
  for (int i = 0; i < 3; ++i)
    c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double length_of(const double a[3]) {
  return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

soft_vessel_def soft_vessel_def_default(void) {
  const soft_vessel_def def = {.wall_young = 0.8,
                               .wall_share = 0.25,
                               .tissue = 0.01,
                               .damping = 0.05,
                               .density = 1.06e-9,
                               .time_step = 0.001};
  return def;
}

/* A direction along an edge and two across it. */
static void axes_of(const double d[3], double axes[3][3]) {
  const double length = length_of(d);
  for (int a = 0; a < 3; ++a) axes[0][a] = length > 0 ? d[a] / length : a == 0;
  const int least = fabs(axes[0][0]) < 0.6 ? 0 : 1;
  const double unit[3] = {least == 0, least == 1, 0};
  cross(axes[0], unit, axes[1]);
  const double across = length_of(axes[1]);
  for (int a = 0; a < 3; ++a) axes[1][a] /= across;
  cross(axes[0], axes[1], axes[2]);
}

/* Second moment of the wall's area about a diameter, mm^4: that of a thin tube. */
static double second_moment(const soft_vessel_def* def, double radius) {
  return kPi * def->wall_share * pow(radius, 4);
}

/* Adds stiffness * row row^T to the blocks of a node and its parent. */
static void add_strain(block_tree* t, uint32_t node, double stiffness, const double child[kBlock],
                       const double parent[kBlock]) {
  const uint32_t above = (uint32_t)t->parent[node];
  for (int a = 0; a < kBlock; ++a)
    for (int b = 0; b < kBlock; ++b) {
      t->diagonal[node][a][b] += stiffness * child[a] * child[b];
      t->diagonal[above][a][b] += stiffness * parent[a] * parent[b];
      t->above[node][a][b] += stiffness * child[a] * parent[b];
    }
}

/* Adds the edge from a node's parent: a beam with shear, strained evenly along its length
 * (Timoshenko's, integrated at its middle, which does not lock). */
static void add_edge(soft_vessel* v, uint32_t node) {
  const blob_node from = blob_model_node(v->rest, (uint32_t)v->tree.parent[node]);
  const blob_node to = blob_model_node(v->rest, node);
  const double radius = 0.5 * (from.radius + to.radius);
  double d[3], axes[3][3];
  for (int a = 0; a < 3; ++a) d[a] = to.centre[a] - from.centre[a];
  axes_of(d, axes);
  /* nodes in one place are held together, not infinitely */
  const double length = fmax(length_of(d), 0.05 * radius);
  const double young = v->def.wall_young, shear = young / 3; /* incompressible */
  const double area = 2 * kPi * v->def.wall_share * radius * radius;
  const double moment = second_moment(&v->def, radius);
  for (int axis = 0; axis < 3; ++axis) {
    const double* e = axes[axis];
    double arm[3], child[kBlock] = {0}, parent[kBlock] = {0};
    cross(axes[0], e, arm);
    for (int a = 0; a < 3; ++a) {
      child[a] = e[a] / length;
      parent[a] = -e[a] / length;
      child[a + 3] = parent[a + 3] = -0.5 * arm[a];
    }
    /* a thin tube shears with half of its area */
    add_strain(&v->tree, node, length * (axis == 0 ? young * area : 0.5 * shear * area), child,
               parent);
    double turn[kBlock] = {0}, back[kBlock] = {0};
    for (int a = 0; a < 3; ++a) {
      turn[a + 3] = e[a] / length;
      back[a + 3] = -e[a] / length;
    }
    add_strain(&v->tree, node, length * (axis == 0 ? 2 * shear * moment : young * moment), turn,
               back);
  }
}

/* Adds to `half` of each node half of the lengths of its edges, mm. */
static void share_edges(const soft_vessel* v, double* half) {
  for (uint32_t i = 0; i < v->count; ++i) {
    if (v->tree.parent[i] < 0) continue;
    const uint32_t above = (uint32_t)v->tree.parent[i];
    const blob_node from = blob_model_node(v->rest, above), to = blob_model_node(v->rest, i);
    double d[3];
    for (int a = 0; a < 3; ++a) d[a] = to.centre[a] - from.centre[a];
    half[i] += 0.5 * length_of(d);
    half[above] += 0.5 * length_of(d);
  }
}

/* Adds tissue, damping and mass of a node that stands for `length` mm of vessel. Tissue grips the
 * wall all around, so it holds against turns, too. */
static void add_surroundings(soft_vessel* v, uint32_t node, double length) {
  scratch* s = v->scratch;
  const double dt = v->def.time_step, radius = blob_model_node(v->rest, node).radius;
  const double square = radius * radius;
  const double mass = v->def.density * kPi * square * (1 + 2 * v->def.wall_share) * length;
  for (int a = 0; a < kBlock; ++a) {
    v->held[node][a] = v->def.tissue * length * (a < 3 ? 1 : square);
    s->mass[node][a] = mass * (a < 3 ? 1 : 0.5 * square);
    v->tree.diagonal[node][a][a] +=
        v->held[node][a] * (1 + v->def.damping / dt) + s->mass[node][a] / (dt * dt);
  }
  /* a beam in an elastic medium: M. Hetenyi, Beams on Elastic Foundation, 1946 */
  const double spring = (v->held[node][0] * (1 + v->def.damping / dt) + mass / (dt * dt)) / length;
  s->decay[node] = pow(spring / (4 * v->def.wall_young * second_moment(&v->def, radius)), 0.25);
}

static int make_matrix(soft_vessel* v) {
  double* half = calloc(v->count, sizeof *half);
  if (half == NULL) return 0;
  share_edges(v, half);
  for (uint32_t i = 0; i < v->count; ++i) {
    const double radius = blob_model_node(v->rest, i).radius;
    add_surroundings(v, i, fmax(half[i], 0.05 * radius));
    if (v->tree.parent[i] >= 0) add_edge(v, i);
  }
  free(half);
  if (!block_tree_factorise(&v->tree)) return 0;
  block_tree_inverse(&v->tree, ((scratch*)v->scratch)->compliance);
  return 1;
}

static int make_tree(soft_vessel* v) {
  int32_t* parent = calloc(v->count, sizeof *parent);
  if (parent == NULL) return 0;
  for (uint32_t i = 0; i < v->count; ++i) parent[i] = blob_model_node(v->rest, i).parent;
  const int good = block_tree_create(&v->tree, v->count, parent);
  free(parent);
  return good;
}

int soft_vessel_create(soft_vessel* v, const blob_model* rest, const soft_vessel_def* def) {
  memset(v, 0, sizeof *v);
  v->def = *def;
  v->rest = rest;
  v->count = blob_model_describe(rest).node_count;
  const size_t n = v->count;
  scratch* s = calloc(1, sizeof *s);
  v->scratch = s;
  if (s == NULL) return 0;
  v->moved = calloc(n, sizeof v->moved[0]);
  v->held = calloc(n, sizeof v->held[0]);
  s->before = calloc(n, sizeof s->before[0]);
  s->velocity = calloc(n, sizeof s->velocity[0]);
  s->mass = calloc(n, sizeof s->mass[0]);
  s->load = calloc(n, sizeof s->load[0]);
  s->posed = calloc(n, sizeof s->posed[0]);
  s->compliance = calloc(n, sizeof s->compliance[0]);
  s->decay = calloc(n, sizeof s->decay[0]);
  s->awake = calloc(n, 1);
  s->moving = calloc(n, sizeof s->moving[0]);
  s->nodes = calloc(n, sizeof s->nodes[0]);
  s->transforms = calloc(n, sizeof s->transforms[0]);
  if (v->moved && v->held && s->before && s->velocity && s->mass && s->load && s->posed &&
      s->compliance && s->decay && s->awake && s->moving && s->nodes && s->transforms &&
      make_tree(v) && make_matrix(v) && blob_pose_create(rest, NULL, &v->pose) == BLOB_OK)
    return 1;
  soft_vessel_destroy(v);
  return 0;
}

void soft_vessel_destroy(soft_vessel* v) {
  scratch* s = v->scratch;
  if (s != NULL) {
    free(s->before);
    free(s->velocity);
    free(s->mass);
    free(s->load);
    free(s->posed);
    free(s->compliance);
    free(s->decay);
    free(s->awake);
    free(s->moving);
    free(s->nodes);
    free(s->transforms);
  }
  free(s);
  free(v->moved);
  free(v->held);
  block_tree_destroy(&v->tree);
  blob_pose_close(v->pose);
  memset(v, 0, sizeof *v);
}

const blob_model* soft_vessel_model(const soft_vessel* v) {
  return blob_pose_model(v->pose);
}

/* Wakes a node and all nodes on its way to the root. */
static void wake(soft_vessel* v, int32_t node) {
  scratch* s = v->scratch;
  for (; node >= 0 && !s->awake[node]; node = v->tree.parent[node]) {
    s->awake[node] = 1;
    s->woken = 1;
  }
}

/* Adds a force on the wall at a point to the nodes that answer there. */
static void add_load(soft_vessel* v, const double point[3], uint32_t cursor,
                     const double force[3]) {
  scratch* s = v->scratch;
  uint32_t nodes[kWeights];
  double weights[kWeights];
  const size_t found =
      blob_query_weights(soft_vessel_model(v), v->flags, point, &cursor, nodes, weights, kWeights);
  for (size_t k = 0; k < found && k < kWeights; ++k) {
    const blob_node node = blob_model_node(soft_vessel_model(v), nodes[k]);
    double arm[3], torque[3];
    for (int a = 0; a < 3; ++a) arm[a] = point[a] - node.centre[a];
    cross(arm, force, torque);
    wake(v, (int32_t)nodes[k]);
    for (int a = 0; a < 3; ++a) {
      s->load[nodes[k]][a] += weights[k] * force[a];
      s->load[nodes[k]][a + 3] += weights[k] * torque[a];
    }
  }
}

/* Begins a step: what has moved becomes where it moves from. */
static void begin_step(soft_vessel* v) {
  scratch* s = v->scratch;
  for (size_t n = 0; n < s->moving_count; ++n)
    for (int a = 0; a < kBlock; ++a) {
      const uint32_t i = s->moving[n];
      s->velocity[i][a] = (v->moved[i][a] - s->before[i][a]) / v->def.time_step;
      s->before[i][a] = v->moved[i][a];
    }
}

/* The quaternion of a rotation vector. */
static void quaternion_of(const double turn[3], double q[4]) {
  const double angle = length_of(turn), half = 0.5 * angle;
  const double scale = angle > 1e-9 ? sin(half) / angle : 0.5;
  for (int a = 0; a < 3; ++a) q[a] = scale * turn[a];
  q[3] = cos(half);
}

/* Takes over nodes that were woken, and the children of nodes that move. */
static void find_moving(soft_vessel* v) {
  scratch* s = v->scratch;
  if (!s->woken) return;
  s->woken = 0;
  s->moving_count = 0;
  for (size_t n = 0; n < v->count; ++n) {
    const uint32_t i = v->tree.order[n];
    const int32_t above = v->tree.parent[i];
    if (!s->awake[i] && above >= 0 && length_of(s->posed[above]) > 0) s->awake[i] = 1;
    if (s->awake[i]) s->moving[s->moving_count++] = i;
  }
}

/* Sets the nodes of the model that moved since they were set. */
static void pose_nodes(soft_vessel* v) {
  scratch* s = v->scratch;
  size_t count = 0;
  for (size_t n = 0; n < s->moving_count; ++n) {
    const uint32_t i = s->moving[n];
    double most = 0;
    for (int a = 0; a < kBlock; ++a) most = fmax(most, fabs(v->moved[i][a] - s->posed[i][a]));
    if (most < kUnseen) continue;
    /* its children begin to move */
    if (length_of(s->posed[i]) == 0) s->woken = 1;
    memcpy(s->posed[i], v->moved[i], sizeof s->posed[i]);
    const blob_node rest = blob_model_node(v->rest, i);
    blob_transform* t = &s->transforms[count];
    for (int a = 0; a < 3; ++a) t->centre[a] = rest.centre[a] + v->moved[i][a];
    quaternion_of(&v->moved[i][3], t->rotation);
    t->factor = 1;
    s->nodes[count++] = i;
  }
  if (count > 0) blob_pose_set(v->pose, count, s->nodes, s->transforms, NULL);
}

/* The way, mm/N, that the wall gives along its normal at a point for each newton more there. */
static double yield_at(const soft_vessel* v, const wall_load* load, size_t i) {
  const uint32_t node = load->cursors[i];
  const blob_node at = blob_model_node(soft_vessel_model(v), node);
  double arm[3], along[kBlock], sum = 0;
  for (int a = 0; a < 3; ++a) {
    arm[a] = load->points[i][a] - at.centre[a];
    along[a] = load->normals[i][a];
  }
  cross(arm, load->normals[i], &along[3]);
  const scratch* s = v->scratch;
  for (int a = 0; a < kBlock; ++a)
    for (int b = 0; b < kBlock; ++b) sum += along[a] * s->compliance[node][a][b] * along[b];
  return sum;
}

/* The share of what a force moves at point i that reaches point k, its neighbour along the rod. */
static double fade(const soft_vessel* v, const wall_load* load, size_t i, size_t k) {
  double d[3];
  for (int a = 0; a < 3; ++a) d[a] = load->points[k][a] - load->points[i][a];
  return exp(-((const scratch*)v->scratch)->decay[load->cursors[i]] * length_of(d));
}

/* Bounds how far the wall gives way at each point when all contacts nearby press more: what it
 * gives way alone, times the number of contacts about it, those far away counting less as the
 * vessel's bending fades (Hetenyi: the sums over such a wave and over this exponential are equal). */
static void bound_yields(const soft_vessel* v, const wall_load* load, double* yields) {
  double sum = 0;
  for (size_t i = 0; i < load->count; ++i) {
    if (i > 0) sum *= fade(v, load, i - 1, i);
    yields[i] = sum;
    sum += length_of(load->forces[i]) > 0;
  }
  sum = 0;
  for (size_t i = load->count; i-- > 0;) {
    if (i + 1 < load->count) sum *= fade(v, load, i + 1, i);
    yields[i] = (1 + yields[i] + sum) * yield_at(v, load, i);
    sum += length_of(load->forces[i]) > 0;
  }
}

static void press(void* self, int first, const wall_load* load, double* yields) {
  soft_vessel* v = self;
  scratch* s = v->scratch;
  const double dt = v->def.time_step;
  if (first) begin_step(v);
  memset(s->load, 0, v->count * sizeof s->load[0]);
  memset(v->reaction, 0, sizeof v->reaction);
  for (size_t i = 0; i < load->count; ++i) {
    if (length_of(load->forces[i]) == 0) continue;
    add_load(v, load->points[i], load->cursors[i], load->forces[i]);
    for (int a = 0; a < 3; ++a) v->reaction[a] += load->forces[i][a];
  }
  find_moving(v);
  for (size_t n = 0; n < s->moving_count; ++n)
    for (int a = 0; a < kBlock; ++a) {
      const uint32_t i = s->moving[n];
      s->load[i][a] += v->held[i][a] * v->def.damping / dt * s->before[i][a] +
                       s->mass[i][a] / (dt * dt) * (s->before[i][a] + dt * s->velocity[i][a]);
    }
  block_tree_solve(&v->tree, s->moving_count, s->moving, s->load);
  for (size_t n = 0; n < s->moving_count; ++n)
    memcpy(v->moved[s->moving[n]], s->load[s->moving[n]], sizeof v->moved[0]);
  pose_nodes(v);
  bound_yields(v, load, yields);
}

static void query_vessel(void* self, size_t count, const double (*points)[3], uint32_t* cursors,
                         double* distances, double (*normals)[3]) {
  soft_vessel* v = self;
  wall_query_model(soft_vessel_model(v), v->flags, count, points, cursors, distances, normals);
}

static void leave_open(void* self) {
  (void)self;
}

wall wall_of_soft_vessel(soft_vessel* v, uint32_t flags, uint32_t start) {
  v->flags = flags;
  const wall w = {v,     query_vessel, leave_open,
                  press, start,        blob_model_describe(v->rest).blob_count};
  return w;
}

void soft_vessel_tissue_force(const soft_vessel* v, double sum[3]) {
  memset(sum, 0, 3 * sizeof sum[0]);
  for (size_t i = 0; i < v->count; ++i)
    for (int a = 0; a < 3; ++a) sum[a] -= v->held[i][a] * v->moved[i][a];
}

double soft_vessel_displacement(const soft_vessel* v) {
  double most = 0;
  for (size_t i = 0; i < v->count; ++i) most = fmax(most, length_of(v->moved[i]));
  return most;
}
