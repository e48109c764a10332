/* SPDX-License-Identifier: Apache-2.0 */
#include "rod.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "banded.h"

static const double kPi = 3.14159265358979324;
static const double kRelaxation =
    0.5;                             /* share of a change of force that a soft wall bears at once */
static const double kNoForce = 1e-9; /* N */

/* Memory that every step reuses. */
typedef struct scratch {
  double (*lower)[kBand]; /* Hessian of the step's energy, see banded_solve() */
  double* gradient;       /* then the Newton step */
  double (*before)[3];    /* positions before the step */
  double (*inertial)[3];  /* positions of nodes without forces */
  double* distances;
  double (*normals)[3];
  double (*touched)[3]; /* points at the wall, and forces there */
  double (*pushes)[3];
  double* yields;
} scratch;

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double now(void) {
  struct timespec t;
  timespec_get(&t, TIME_UTC);
  /* seconds of a day leave a double enough digits for nanoseconds */
  return (double)(t.tv_sec % 86400) + 1e-9 * (double)t.tv_nsec;
}

rod_def rod_def_default(void) {
  const rod_def def = {.elements = 200,
                       .element_length = 0.5,
                       .radius = 0.15,
                       .young = 1e5,
                       .density = 6.5e-9,
                       .friction = 0.1,
                       .time_step = 0.001,
                       .iterations = 4,
                       .direction = {1, 0, 0}};
  return def;
}

static double bending_stiffness(const rod_def* def) {
  const double h = def->element_length;
  return def->young * 0.25 * kPi * pow(def->radius, 4) / (h * h * h);
}

/* Stiffness at which a contact's multiplier settles within a few iterations, for any rod. */
static double contact_stiffness(const rod_def* def) {
  return 10 * bending_stiffness(def);
}

/* Stiffness of a contact, with the wall's own where it gives way. */
static double stiffness_at(const rod* r, size_t i) {
  return 1 / (1 / contact_stiffness(&r->def) + r->contact[i].yield);
}

/* Places the nodes that are still on the guide. */
static void place_on_guide(rod* r) {
  const double h = r->def.element_length;
  r->free_count = 0;
  for (size_t i = 0; i < r->node_count; ++i) {
    const double past = r->inserted - (double)i * h;
    if (past > 0) {
      r->free_count = i + 1;
      continue;
    }
    for (int a = 0; a < 3; ++a) {
      r->position[i][a] = r->def.entry[a] + past * r->def.direction[a];
      r->velocity[i][a] = 0;
    }
  }
}

int rod_create(rod* r, const rod_def* def, const wall* w, double inserted) {
  memset(r, 0, sizeof *r);
  const size_t n = def->elements + 1;
  scratch* s = calloc(1, sizeof *s);
  r->scratch = s;
  if (s == NULL) return 0;
  r->def = *def;
  r->node_count = n;
  r->position = calloc(n, sizeof r->position[0]);
  r->velocity = calloc(n, sizeof r->velocity[0]);
  r->cursor = calloc(n, sizeof r->cursor[0]);
  r->contact = calloc(n, sizeof r->contact[0]);
  s->lower = calloc(3 * n, sizeof s->lower[0]);
  s->gradient = calloc(3 * n, sizeof s->gradient[0]);
  s->before = calloc(n, sizeof s->before[0]);
  s->inertial = calloc(n, sizeof s->inertial[0]);
  s->distances = calloc(n, sizeof s->distances[0]);
  s->normals = calloc(n, sizeof s->normals[0]);
  s->touched = calloc(n, sizeof s->touched[0]);
  s->pushes = calloc(n, sizeof s->pushes[0]);
  s->yields = calloc(n, sizeof s->yields[0]);
  if (!r->position || !r->velocity || !r->cursor || !r->contact || !s->lower || !s->gradient ||
      !s->before || !s->inertial || !s->distances || !s->normals || !s->touched || !s->pushes ||
      !s->yields) {
    rod_destroy(r);
    return 0;
  }
  r->inserted = inserted;
  for (size_t i = 0; i < n; ++i) {
    r->cursor[i] = w->start_cursor;
    for (int a = 0; a < 3; ++a)
      r->position[i][a] =
          def->entry[a] + (inserted - (double)i * def->element_length) * def->direction[a];
  }
  place_on_guide(r);
  return 1;
}

void rod_destroy(rod* r) {
  scratch* s = r->scratch;
  if (s != NULL) {
    free(s->lower);
    free(s->gradient);
    free(s->before);
    free(s->inertial);
    free(s->distances);
    free(s->normals);
    free(s->touched);
    free(s->pushes);
    free(s->yields);
  }
  free(s);
  free(r->position);
  free(r->velocity);
  free(r->cursor);
  free(r->contact);
  memset(r, 0, sizeof *r);
}

static void detect(rod* r, const wall* w) {
  scratch* s = r->scratch;
  const double begin = now();
  w->query(w->self, r->free_count, (const double(*)[3])r->position, r->cursor, s->distances,
           s->normals);
  r->wall_seconds += now() - begin;
  for (size_t i = 0; i < r->free_count; ++i) {
    rod_contact* c = &r->contact[i];
    c->distance = s->distances[i];
    memcpy(c->normal, s->normals[i], sizeof c->normal);
    memcpy(c->anchor, r->position[i], sizeof c->anchor);
  }
}

/* Adds a 3 by 3 block for the nodes i and j, i >= j; guide nodes do not move and have no rows. */
static void add_block(rod* r, size_t i, size_t j, double block[3][3]) {
  scratch* s = r->scratch;
  if (i >= r->free_count || j >= r->free_count) return;
  for (size_t a = 0; a < 3; ++a)
    for (size_t b = 0; b < (i == j ? a + 1 : 3); ++b)
      s->lower[3 * i + a][kBand - 1 - (3 * (i - j) + a - b)] += block[a][b];
}

static void add_force(rod* r, size_t i, double scale, const double v[3]) {
  scratch* s = r->scratch;
  if (i >= r->free_count) return;
  for (size_t a = 0; a < 3; ++a) s->gradient[3 * i + a] += scale * v[a];
}

/* Adds the block scale * (I + share * n n^T). */
static void add_directed(rod* r, size_t i, size_t j, double scale, double share,
                         const double n[3]) {
  double block[3][3];
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) block[a][b] = scale * ((a == b) + share * n[a] * n[b]);
  add_block(r, i, j, block);
}

static void add_inertia(rod* r) {
  const scratch* s = r->scratch;
  const rod_def* d = &r->def;
  const double area = kPi * d->radius * d->radius;
  const double mass = d->density * area * d->element_length / (d->time_step * d->time_step);
  const double zero[3] = {0, 0, 0};
  for (size_t i = 0; i < r->free_count; ++i) {
    double away[3];
    for (int a = 0; a < 3; ++a) away[a] = r->position[i][a] - s->inertial[i][a];
    add_force(r, i, mass, away);
    add_directed(r, i, i, mass, 0, zero);
  }
}

/* Adds the energy k/2 |x[i-1] - 2 x[i] + x[i+1]|^2. */
static void add_bending(rod* r) {
  static const double weight[3] = {1, -2, 1};
  const double k = bending_stiffness(&r->def), zero[3] = {0, 0, 0};
  for (size_t i = 1; i + 1 < r->node_count && i <= r->free_count; ++i) {
    double second[3];
    for (int a = 0; a < 3; ++a)
      second[a] = r->position[i - 1][a] - 2 * r->position[i][a] + r->position[i + 1][a];
    for (size_t p = 0; p < 3; ++p) {
      add_force(r, i + p - 1, k * weight[p], second);
      for (size_t q = 0; q <= p; ++q)
        add_directed(r, i + p - 1, i + q - 1, k * weight[p] * weight[q], 0, zero);
    }
  }
}

/* Adds the energy k/2 (length - h)^2. Under compression the part of its Hessian across the element
 * is negative and left out: the matrix stays positive definite. */
static void add_stretching(rod* r) {
  const rod_def* d = &r->def;
  const double h = d->element_length, k = d->young * kPi * d->radius * d->radius / h;
  for (size_t i = 0; i + 1 < r->node_count && i < r->free_count; ++i) {
    double n[3];
    for (int a = 0; a < 3; ++a) n[a] = r->position[i + 1][a] - r->position[i][a];
    const double length = sqrt(dot(n, n));
    for (int a = 0; a < 3; ++a) n[a] /= length;
    add_force(r, i + 1, k * (length - h), n);
    add_force(r, i, -k * (length - h), n);
    const double across = fmax(k * (1 - h / length), 1e-9 * k), share = (k - across) / across;
    add_directed(r, i, i, across, share, n);
    add_directed(r, i + 1, i + 1, across, share, n);
    add_directed(r, i + 1, i, -across, share, n);
  }
}

/* Depth of a node beyond the wall's plane, mm. */
static double depth(const rod* r, size_t i) {
  const rod_contact* c = &r->contact[i];
  double moved[3];
  for (int a = 0; a < 3; ++a) moved[a] = r->position[i][a] - c->anchor[a];
  return c->distance + r->def.radius + dot(c->normal, moved);
}

static void add_friction(rod* r, size_t i, double pressing) {
  const scratch* s = r->scratch;
  const double k = stiffness_at(r, i), *n = r->contact[i].normal;
  double slip[3];
  for (int a = 0; a < 3; ++a) slip[a] = r->position[i][a] - s->before[i][a];
  const double out = dot(slip, n);
  for (int a = 0; a < 3; ++a) slip[a] -= out * n[a];
  const double length = sqrt(dot(slip, slip)), limit = r->def.friction * pressing;
  const double stiffness = length * k > limit ? limit / length : k;
  for (int a = 0; a < 3; ++a) r->contact[i].drag[a] = stiffness * slip[a];
  add_force(r, i, stiffness, slip);
  add_directed(r, i, i, stiffness, -1, n);
}

/* Adds contacts: a node in the wall is held on its plane until the force for this would pull. */
static void add_contacts(rod* r) {
  for (size_t i = 0; i < r->free_count; ++i) {
    rod_contact* c = &r->contact[i];
    const double k = stiffness_at(r, i), none = 1e-12 * k;
    memset(c->drag, 0, sizeof c->drag);
    if (depth(r, i) > 0) c->active = 1;
    if (!c->active) continue;
    const double pressing = c->force + k * depth(r, i);
    add_force(r, i, pressing, c->normal);
    add_directed(r, i, i, none, k / none, c->normal);
    if (r->def.friction > 0 && pressing > 0) add_friction(r, i, pressing);
  }
}

/* Updates contact forces after `share` of the step -g, which balances the forces if taken whole. */
static void update_forces(rod* r, double share, const double* g) {
  r->contact_count = 0;
  for (size_t i = 0; i < r->free_count; ++i) {
    rod_contact* c = &r->contact[i];
    if (!c->active) continue;
    const double k = stiffness_at(r, i);
    c->force += share * k * (depth(r, i) - dot(c->normal, &g[3 * i]));
    c->active = c->force > 0;
    if (!c->active) c->force = 0;
    r->contact_count += (size_t)c->active;
  }
}

/* Moves all free nodes by a Newton step, none of them farther than a quarter of an element. */
static void newton_step(rod* r) {
  scratch* s = r->scratch;
  const size_t size = 3 * r->free_count;
  memset(s->lower, 0, size * sizeof s->lower[0]);
  memset(s->gradient, 0, size * sizeof s->gradient[0]);
  add_inertia(r);
  add_bending(r);
  add_stretching(r);
  add_contacts(r);
  if (!banded_solve(size, s->lower, s->gradient)) return;
  double most = 0;
  for (size_t i = 0; i < size; ++i) most = fmax(most, fabs(s->gradient[i]));
  const double bound = 0.25 * r->def.element_length, share = most > bound ? bound / most : 1;
  update_forces(r, share, s->gradient);
  for (size_t i = 0; i < r->free_count; ++i)
    for (size_t a = 0; a < 3; ++a) r->position[i][a] -= share * s->gradient[3 * i + a];
}

/* Gives the wall its share of what changed in the forces on it, which becomes the force of the
 * contact, and learns how far it gives way. */
static void press_wall(rod* r, const wall* w, int first) {
  scratch* s = r->scratch;
  const double begin = now();
  for (size_t i = 0; i < r->free_count; ++i) {
    rod_contact* c = &r->contact[i];
    for (int a = 0; a < 3; ++a) {
      const double wanted = c->active ? c->force * c->normal[a] + c->drag[a] : 0;
      c->push[a] += kRelaxation * (wanted - c->push[a]);
    }
    if (dot(c->push, c->push) < kNoForce * kNoForce) memset(c->push, 0, sizeof c->push);
    c->force = fmax(0, dot(c->push, c->normal));
    c->active = c->force > 0;
    memcpy(s->pushes[i], c->push, sizeof c->push);
    for (int a = 0; a < 3; ++a) s->touched[i][a] = r->position[i][a] + r->def.radius * c->normal[a];
  }
  const wall_load load = {r->free_count, (const double(*)[3])s->touched,
                          (const double(*)[3])s->normals, (const double(*)[3])s->pushes, r->cursor};
  w->press(w->self, first, &load, s->yields);
  for (size_t i = 0; i < r->free_count; ++i) r->contact[i].yield = s->yields[i];
  r->yield_seconds += now() - begin;
}

void rod_step(rod* r, const wall* w, double speed) {
  scratch* s = r->scratch;
  const double dt = r->def.time_step, begin = now();
  const double whole = (double)r->def.elements * r->def.element_length;
  r->inserted = fmin(r->inserted + speed * dt, whole);
  place_on_guide(r);
  for (size_t i = 0; i < r->free_count; ++i)
    for (int a = 0; a < 3; ++a) {
      s->before[i][a] = r->position[i][a];
      s->inertial[i][a] = r->position[i][a] + dt * r->velocity[i][a];
    }
  r->wall_seconds = r->yield_seconds = 0;
  for (int k = 0; k < r->def.iterations; ++k) {
    if (k == 0 || !r->def.detect_once || w->press != NULL) detect(r, w);
    newton_step(r);
    if (w->press != NULL) press_wall(r, w, k == 0);
  }
  for (size_t i = 0; i < r->free_count; ++i)
    for (int a = 0; a < 3; ++a) r->velocity[i][a] = (r->position[i][a] - s->before[i][a]) / dt;
  r->solver_seconds = now() - begin - r->wall_seconds - r->yield_seconds;
}
