/* SPDX-License-Identifier: Apache-2.0 */
/* Pushes a rod into a vessel and reports the path of its tip and the cost of the wall. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rod.h"
#include "score.h"
#include "soft_vessel.h"

typedef struct options {
  const char *model, *mesh, *truth, *path;
  double node, steps, speed, tilt, roll, local, exact, soft;
  rod_def rod;
  soft_vessel_def vessel;
} options;

static const char kUsage[] =
    "Usage: catheter MODEL.lumen [--NAME VALUE]...\n"
    "  mesh FILE.obj     ask this mesh for the wall, not the model\n"
    "  truth FILE.lumen  the surface that gaps are measured to; the model\n"
    "  path FILE.csv     write the tip: step, x, y, z (mm), touches, contacts, wall_us, solver_us\n"
    "  node N            push in at this node, towards its child; 0\n"
    "  tilt DEGREES      turn the guide off the vessel's axis; 0\n"
    "  roll DEGREES      and then about the vessel's axis; 0\n"
    "  steps N           2000\n"
    "  speed MM/S        50\n"
    "  local 1           BLOB_LOCAL;  exact 1: BLOB_DISTANCE_EXACT\n"
    "  elements N 200, element MM 0.5, radius MM 0.15, young N/MM2 1e5, friction 0.1,\n"
    "  iterations N 4, once 1: ask for the wall once in a step\n"
    "  soft 1            a vessel that gives way (soft_vessel.h has the sources of the values):\n"
    "  wall-young N/MM2 0.8, wall-share (thickness over radius) 0.25, tissue N/MM2 0.01,\n"
    "  damping S 0.05\n";

static int set_number(options* o, const char* name, const char* text) {
  double elements = (double)o->rod.elements, iterations = o->rod.iterations, once = 0;
  const struct {
    const char* name;
    double* value;
  } known[] = {{"node", &o->node},
               {"roll", &o->roll},
               {"tilt", &o->tilt},
               {"steps", &o->steps},
               {"speed", &o->speed},
               {"local", &o->local},
               {"exact", &o->exact},
               {"elements", &elements},
               {"element", &o->rod.element_length},
               {"radius", &o->rod.radius},
               {"young", &o->rod.young},
               {"iterations", &iterations},
               {"friction", &o->rod.friction},
               {"once", &once},
               {"soft", &o->soft},
               {"wall-young", &o->vessel.wall_young},
               {"wall-share", &o->vessel.wall_share},
               {"tissue", &o->vessel.tissue},
               {"damping", &o->vessel.damping}};
  for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i) {
    if (strcmp(name, known[i].name) != 0) continue;
    char* end;
    *known[i].value = strtod(text, &end);
    if (*end != '\0' || end == text || !(*known[i].value >= 0)) return 0;
    o->rod.elements = (size_t)elements;
    o->rod.iterations = (int)iterations;
    if (strcmp(name, "once") == 0) o->rod.detect_once = once > 0;
    return o->rod.elements >= 2 && o->rod.element_length > 0 && o->vessel.wall_young > 0 &&
           o->vessel.wall_share > 0 && o->vessel.tissue > 0;
  }
  return 0;
}

static int set_option(options* o, const char* name, const char* value) {
  if (strncmp(name, "--", 2) != 0) return 0;
  name += 2;
  if (strcmp(name, "mesh") == 0) return o->mesh = value, 1;
  if (strcmp(name, "truth") == 0) return o->truth = value, 1;
  if (strcmp(name, "path") == 0) return o->path = value, 1;
  return set_number(o, name, value);
}

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The first child of a node; a node without a parent if there is none. */
static blob_node child_of(const blob_model* model, uint32_t node) {
  const size_t count = blob_model_describe(model).node_count;
  blob_node child = {{0, 0, 0}, 0, -1};
  for (uint32_t i = 0; i < count && child.parent != (int32_t)node; ++i)
    child = blob_model_node(model, i);
  if (child.parent != (int32_t)node) child.parent = -1;
  return child;
}

/* Finds the entry: a node, and the direction along the vessel, tilted and rolled. */
static int find_entry(const blob_model* model, const options* o, rod_def* def) {
  const uint32_t node = (uint32_t)o->node;
  const blob_node at = blob_model_node(model, node), child = child_of(model, node);
  if (child.parent < 0) return 0;
  double along[3], side[3], up[3];
  for (int a = 0; a < 3; ++a) along[a] = child.centre[a] - at.centre[a];
  const double length = sqrt(dot(along, along));
  for (int a = 0; a < 3; ++a) along[a] /= length;
  const int least = fabs(along[0]) < 0.6 ? 0 : 1;
  for (int a = 0; a < 3; ++a)
    side[a] = ((a == least) - along[least] * along[a]) / sqrt(1 - along[least] * along[least]);
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    up[a] = along[b] * side[c] - along[c] * side[b];
  }
  const double degree = 3.14159265358979324 / 180, tilt = o->tilt * degree, roll = o->roll * degree;
  for (int a = 0; a < 3; ++a) {
    def->entry[a] = at.centre[a];
    def->direction[a] =
        cos(tilt) * along[a] + sin(tilt) * (cos(roll) * side[a] + sin(roll) * up[a]);
  }
  return 1;
}

typedef struct record {
  size_t steps, contacts, most_contacts;
  double (*tip)[3];
  unsigned char* touches;
  double *wall_seconds, *solver_seconds, *yield_seconds; /* seconds of each step */
  double deepest, deepest_ever; /* mm beyond the wall at the end, and in any tenth step */
} record;

/* The rod's deepest node, mm beyond the wall, shows a rod that left the lumen. With `own`, the wall
 * is that of the vessel in which the rod keeps its cursors, not of any vessel. */
static double deepest_of(const rod* r, const blob_model* truth, int own) {
  double deepest = -INFINITY;
  for (size_t i = 0; i < r->free_count; ++i) {
    blob_sample s;
    uint32_t cursor = r->cursor[i];
    blob_query(truth, BLOB_DISTANCE_EXACT, r->position[i], own ? &cursor : NULL, &s);
    deepest = fmax(deepest, s.distance + r->def.radius);
  }
  return deepest;
}

static void note_step(record* log, size_t k, const rod* r, const blob_model* truth, int own) {
  memcpy(log->tip[k], r->position[0], sizeof log->tip[k]);
  log->touches[k] = r->contact[0].force > 0;
  log->contacts += r->contact_count;
  if (r->contact_count > log->most_contacts) log->most_contacts = r->contact_count;
  log->wall_seconds[k] = r->wall_seconds;
  log->solver_seconds[k] = r->solver_seconds;
  log->yield_seconds[k] = r->yield_seconds;
  if (k % 10 == 9 || k + 1 == log->steps) {
    log->deepest = deepest_of(r, truth, own);
    log->deepest_ever = fmax(log->deepest_ever, log->deepest);
  }
}

static int push(const options* o, const rod_def* def, const wall* w, const blob_model* truth,
                record* log) {
  rod r;
  FILE* csv = o->path != NULL ? fopen(o->path, "w") : NULL;
  if ((o->path != NULL && csv == NULL) || !rod_create(&r, def, w, 0)) return 0;
  if (csv != NULL) fprintf(csv, "step,x,y,z,touches,contacts,wall_us,solver_us\n");
  log->deepest_ever = -INFINITY;
  for (size_t k = 0; k < log->steps; ++k) {
    rod_step(&r, w, o->speed);
    note_step(log, k, &r, truth, o->mesh == NULL && o->truth == NULL);
    const double* tip = r.position[0];
    if (csv != NULL)
      fprintf(csv, "%zu,%.9g,%.9g,%.9g,%d,%zu,%.3f,%.3f\n", k, tip[0], tip[1], tip[2],
              log->touches[k], r.contact_count, 1e6 * r.wall_seconds, 1e6 * r.solver_seconds);
  }
  rod_destroy(&r);
  return csv == NULL || fclose(csv) == 0;
}

static int compare(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

/* Median time, ms, of the last tenth of the steps, when most of the rod is in. The median ignores
 * the system's interruptions. */
static double median_ms(const record* log, double* seconds) {
  const size_t tail = log->steps / 10 + 1;
  double* last = seconds + log->steps - tail;
  qsort(last, tail, sizeof *last, compare);
  return 1e3 * last[tail / 2];
}

/* Forces and motion of a vessel that gave way. */
static void report_vessel(const soft_vessel* v) {
  double held[3];
  soft_vessel_tissue_force(v, held);
  printf(" \"vessel_moved_mm\": %.4f, \"force_on_wall_N\": %.6f, \"force_of_tissue_N\": %.6f,\n",
         soft_vessel_displacement(v), sqrt(dot(v->reaction, v->reaction)), sqrt(dot(held, held)));
}

static void report(const options* o, const wall* w, const soft_vessel* vessel, record* log,
                   const score* s) {
  const double* tip = log->tip[log->steps - 1];
  const double n = (double)log->steps;
  printf("{\"wall\": \"%s\", \"primitives\": %zu, \"steps\": %zu,\n",
         o->mesh  ? "mesh"
         : vessel ? "soft"
                  : "model",
         w->primitives, log->steps);
  if (vessel != NULL) report_vessel(vessel);
  printf(" \"tip\": [%.6f, %.6f, %.6f], \"deepest_mm\": %.6f,\n", tip[0], tip[1], tip[2],
         log->deepest);
  printf(" \"deepest_ever_mm\": %.6f,\n", log->deepest_ever);
  printf(" \"contacts_mean\": %.1f, \"contacts_most\": %zu,\n", (double)log->contacts / n,
         log->most_contacts);
  const double wall_ms = median_ms(log, log->wall_seconds);
  const double solver_ms = median_ms(log, log->solver_seconds);
  const double yield_ms = median_ms(log, log->yield_seconds);
  printf(" \"wall_ms\": %.5f, \"solver_ms\": %.5f, \"yield_ms\": %.5f,\n", wall_ms, solver_ms,
         yield_ms);
  printf(" \"steps_per_second\": %.0f,\n", 1e3 / (wall_ms + solver_ms + yield_ms));
  printf(" \"used\": %zu, \"line_rms_mm\": %.7f, \"gap_jerk_mm\": %.7f,\n", s->used, s->line_rms,
         s->gap_jerk);
  printf(" \"gap_mm\": {\"min\": %.7f, \"median\": %.7f, \"p90\": %.7f, \"max\": %.7f}}\n",
         s->gap_min, s->gap_median, s->gap_90, s->gap_max);
}

static int make_record(record* log, size_t steps) {
  log->steps = steps;
  log->tip = calloc(steps + 1, sizeof log->tip[0]);
  log->touches = calloc(steps + 1, 1);
  log->wall_seconds = calloc(steps + 1, sizeof(double));
  log->solver_seconds = calloc(steps + 1, sizeof(double));
  log->yield_seconds = calloc(steps + 1, sizeof(double));
  return steps > 0 && log->tip && log->touches && log->wall_seconds && log->solver_seconds &&
         log->yield_seconds;
}

static void free_record(record* log) {
  free(log->tip);
  free(log->touches);
  free(log->wall_seconds);
  free(log->solver_seconds);
  free(log->yield_seconds);
}

/* The wall that the options ask for: of the vessel if it gives way, a mesh, or the model. */
static wall make_wall(const options* o, const blob_model* model, soft_vessel* vessel) {
  const uint32_t flags = (o->local > 0 ? BLOB_LOCAL : 0) | (o->exact > 0 ? BLOB_DISTANCE_EXACT : 0);
  wall w = {0};
  if (vessel != NULL) return wall_of_soft_vessel(vessel, flags, (uint32_t)o->node);
  if (o->mesh == NULL) w = wall_of_model(model, flags, (uint32_t)o->node);
#ifdef CATHETER_HAS_EMBREE
  if (o->mesh != NULL) w = wall_of_obj(o->mesh, 1.0);
#endif
  return w;
}

/* Pushes and reports; `vessel` is null if the wall is rigid. */
static int run_in(options* o, const blob_model* model, const blob_model* truth,
                  soft_vessel* vessel) {
  wall w = make_wall(o, model, vessel);
  if (w.self == NULL) {
    fprintf(stderr, "catheter: no wall from %s\n", o->mesh ? o->mesh : o->model);
    return 1;
  }
  record log = {0};
  if (vessel != NULL) truth = soft_vessel_model(vessel);
  const int good = make_record(&log, (size_t)o->steps) && push(o, &o->rod, &w, truth, &log);
  if (good) {
    const score s =
        score_path(truth, log.steps, (const double(*)[3])log.tip, log.touches, o->rod.radius);
    report(o, &w, vessel, &log, &s);
  }
  free_record(&log);
  w.close(w.self);
  return good ? 0 : 1;
}

static int run(options* o, const blob_model* model, const blob_model* truth) {
  if (!find_entry(model, o, &o->rod)) {
    fprintf(stderr, "catheter: node %.0f has no child to push towards\n", o->node);
    return 1;
  }
  if (o->soft == 0) return run_in(o, model, truth, NULL);
  if (o->mesh != NULL) {
    fputs("catheter: --soft moves the model, so it cannot go with --mesh\n", stderr);
    return 2;
  }
  soft_vessel vessel;
  o->vessel.time_step = o->rod.time_step;
  if (!soft_vessel_create(&vessel, model, &o->vessel)) {
    fprintf(stderr, "catheter: no vessel that gives way from %s\n", o->model);
    return 1;
  }
  const int status = run_in(o, model, truth, &vessel);
  soft_vessel_destroy(&vessel);
  return status;
}

static blob_model* open_model(const char* path) {
  char message[300] = "";
  blob_open_def def = blob_open_def_default();
  def.message = message;
  def.message_size = sizeof message;
  blob_model* model = NULL;
  if (blob_model_open(path, &def, &model) != BLOB_OK)
    fprintf(stderr, "catheter: %s: %s\n", path, message);
  return model;
}

int main(int argc, char** argv) {
  options o = {
      .steps = 2000, .speed = 50, .rod = rod_def_default(), .vessel = soft_vessel_def_default()};
  int good = argc >= 2 && argc % 2 == 0;
  for (int i = 2; good && i < argc; i += 2) good = set_option(&o, argv[i], argv[i + 1]);
  if (!good) {
    fputs(kUsage, stderr);
    return 2;
  }
  o.model = argv[1];
  blob_model* model = open_model(o.model);
  blob_model* truth = model != NULL && o.truth != NULL ? open_model(o.truth) : model;
  const int status = model == NULL || truth == NULL ? 1 : run(&o, model, truth);
  if (truth != model) blob_model_close(truth);
  blob_model_close(model);
  return status;
}
