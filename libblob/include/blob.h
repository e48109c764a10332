/* SPDX-License-Identifier: Apache-2.0
 *
 * libblob: signed distance, gradient and inside test of a vessel tree for simulators (C99, C++11).
 *
 * A vessel tree is a set of nodes along centerlines. Each node has a centre O, a radius r and its
 * own smooth implicit function, a sum of a few blobs (A. Yureidini, Robust blood vessel surface
 * reconstruction for interactive simulations from patient data, 2014):
 *
 *     f_k(X) = sum over node k's blobs j of  w_j * phi(|X - C_j|^2 / w_j^2)
 *
 * Nodes that are neighbours along the tree blend into one field f, see BLOB_BLENDED. The wall is
 * f = T (the iso-level), the lumen is f > T, and f falls outwards. See spec/lumen.md.
 *
 * A tool point remembers its node, its cursor, and moves it along the tree only, never across
 * space: two vessels that touch stay two vessels. So a query looks at one node, or at the few that
 * blend, however large the tree is.
 *
 * In short:
 *
 *     blob_model* vessel;
 *     if (blob_model_open("head.lumen", NULL, &vessel) != BLOB_OK) return 1;
 *     uint32_t cursor = BLOB_NOWHERE;            // one per tool point, kept from step to step
 *     blob_sample s;
 *     blob_query(vessel, 0, point, &cursor, &s); // inside: s.distance < 0; s.normal is outward
 *     blob_model_close(vessel);
 *
 * How to read this header. Each function's comment states, in this order: the computation, the
 * caller's arguments, the result, failures, and the cost. n is the number of nodes and b the number
 * of blobs of a node. Measured times and errors are in libblob/README.md.
 *
 * Units and frame. Lengths are millimetres, in the frame of the case: LPS (+x left, +y posterior,
 * +z superior). f and T are lengths, grad f has no unit.
 *
 * Sign. Distances are negative in the lumen. MuJoCo's signed distance fields, SOFA's distance grids
 * and Bullet's are positive where a tool may move: negate.
 *
 * Failure. Constructions return a blob_status. Queries cannot fail: they never allocate, lock, log
 * or throw, and are defined for every point. A NaN coordinate gives NaN numbers, "outside" and an
 * unmoved cursor; an infinite one gives f = 0, an infinite distance, a zero normal and "outside".
 * Null pointers (where not allowed) and closed models are misuse: a call to the misuse handler in
 * debug builds, undefined otherwise.
 *
 * Threads. A model does not change after construction; any number of threads may query it. The only
 * other shared state is the handler of blob_set_misuse_handler().
 *
 * Arithmetic. Points are doubles. Within a node's neighbourhood the work is done in floats relative
 * to the node's centre, with a relative error of some 1e-6; blob_query_hessian() works in doubles.
 * Every SIMD back end gives the same bits as the scalar one on every machine (BLOB_DISTANCE_EXACT
 * also calls the C library's hypot, sin, cos and atan2: the last bits are that library's), batches
 * give the bits of single queries, and no result depends on the number of threads.
 */
#ifndef LUMEN_BLOB_H
#define LUMEN_BLOB_H

/* Comments stand in columns. */
/* clang-format off */

#include <stddef.h>
#include <stdint.h>

#if defined(BLOB_STATIC)
#define BLOB_API
#elif defined(_WIN32) && defined(BLOB_BUILDING)
#define BLOB_API __declspec(dllexport)
#elif defined(_WIN32)
#define BLOB_API __declspec(dllimport)
#else
#define BLOB_API __attribute__((visibility("default")))
#endif
#ifdef __cplusplus
#define BLOB_NOEXCEPT noexcept
extern "C" {
#else
#define BLOB_NOEXCEPT
#endif

#define BLOB_VERSION_MAJOR 0
#define BLOB_VERSION_MINOR 2
#define BLOB_VERSION_PATCH 0

/* ---------------------------------------------------------------- status */

/* Result of a construction. Values are only appended. */
typedef enum blob_status {
  BLOB_OK = 0,
  BLOB_ERROR_MEMORY = 1,    /* the system has no more memory */
  BLOB_ERROR_ARGUMENT = 2,  /* a null pointer, or a definition not made by its default function */
  BLOB_ERROR_FILE = 3,      /* the file cannot be opened or read, or is empty */
  BLOB_ERROR_FORMAT = 4,    /* the bytes are not a .lumen file, or break a rule of the format */
  BLOB_ERROR_CHECKSUM = 5,  /* the bytes do not match their checksum */
  BLOB_ERROR_ENCODING = 6,  /* a required chunk is stored compressed; convert the file to raw */
  BLOB_ERROR_NO_MODELS = 7, /* the case has no models: fit it first */
  BLOB_ERROR_EMPTY = 8,     /* there is no node */
  BLOB_ERROR_LIMIT = 9,     /* more nodes, blobs or links than the limits below */
  BLOB_ERROR_RANGE = 10,    /* a number is not finite or out of its range, see blob_model_def */
  BLOB_ERROR_TOPOLOGY = 11, /* a parent, link or offset refers to an index that does not exist */
  BLOB_ERROR_KERNEL = 12,   /* there is no such kernel */
  BLOB_ERROR_NO_MOTION = 13 /* the case has no motion */
} blob_status;

/* Describes a status.
 * Takes any value, also one that is no status.
 * Returns one English sentence without a full stop, static, never null. O(1). */
BLOB_API const char* blob_status_text(blob_status status) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- model */

/* An immutable vessel tree with its blobs. */
typedef struct blob_model blob_model;

/* phi(x) of x = |X - C|^2 / w^2. Values are those of the file format. */
typedef enum blob_kernel {
  BLOB_CAUCHY = 0,     /* (1 + p x)^-2; infinite support; p = kernel_parameter, usually 0.2 */
  BLOB_GAUSSIAN = 1,   /* exp(-p x); infinite support; usually 0.5; the slowest */
  BLOB_QUARTIC = 2,    /* (1 - x)^2 for x < 1, else 0 */
  BLOB_SOFT_OBJECT = 3 /* 1 - (4/9) x^3 + (17/9) x^2 - (22/9) x for x < 1, else 0 */
} blob_kernel;

/* SIMD instructions of a model's queries. All give the same bits. */
typedef enum blob_simd {
  BLOB_SIMD_BEST = 0,     /* the best that this processor has */
  BLOB_SIMD_SCALAR = 1,   /* the reference */
  BLOB_SIMD_PORTABLE = 2, /* compiler vectors for the build's target: SSE2, NEON, WebAssembly */
  BLOB_SIMD_AVX2 = 3,
  BLOB_SIMD_AVX512 = 4
} blob_simd;

#define BLOB_MAX_NODES 16777216u /* 2^24, as the file format */
#define BLOB_MAX_BLOBS 67108864u /* 2^26 */
#define BLOB_MAX_LINKS 16777216u

/* Options for opening a file. */
typedef struct blob_open_def {
  int verify;          /* 1 (default): every checksum and value; 0: only data that queries use */
  blob_simd simd;      /* BLOB_SIMD_BEST; an unsupported value falls back to the next below */
  char* message;       /* null, or a buffer for a zero-terminated sentence about a failure */
  size_t message_size; /* bytes at `message` */
  uint32_t cookie;     /* set by blob_open_def_default() */
} blob_open_def;

/* Default options: verify everything, best instructions, no message.
 * Returns a definition; change its fields, not its cookie. Cannot fail. O(1). */
BLOB_API blob_open_def blob_open_def_default(void) BLOB_NOEXCEPT;

/* Opens a .lumen file.
 * The caller provides its path (UTF-8), and a definition or null for the default. The file is
 * mapped, read in place and released again.
 * On BLOB_OK *model is a model, to be closed by blob_model_close(); otherwise it is null.
 * Fails with any status; def->message, if not null, receives the place and the reason.
 * O(file size) to verify and O(n) to build. */
BLOB_API blob_status blob_model_open(const char* path, const blob_open_def* def,
                                     blob_model** model) BLOB_NOEXCEPT;

/* Opens a .lumen file that is in memory.
 * The caller provides and keeps `size` bytes of any alignment, and a definition or null. The bytes
 * are read during the call only: the model has its own copy, in blocks for SIMD.
 * Result, failures and cost are those of blob_model_open(), without BLOB_ERROR_FILE. */
BLOB_API blob_status blob_model_open_bytes(const void* bytes, size_t size, const blob_open_def* def,
                                           blob_model** model) BLOB_NOEXCEPT;

/* The blobs of all nodes, node i owning offset[i] .. offset[i + 1] - 1. */
typedef struct blob_blobs {
  blob_kernel kernel;      /* default BLOB_CAUCHY */
  double kernel_parameter; /* default 0.2; 1e-4 to 1e4; not used by kernels without a parameter */
  double iso_level;        /* T, mm; default 0.1; 1e-6 to 1e3 */
  /* node_count + 1 entries, from 0, not decreasing. A node without blobs answers with those of the
   * nearest node along the tree that has some (the fewest edges away; of several, the lowest
   * index), which stay where they are. If its connected component has none, f = 0: it is outside
   * everywhere. */
  const uint32_t* offset;
  const float (*centre)[3]; /* mm, offset[node_count] entries; within 1e6 of zero */
  const float* width;       /* mm, offset[node_count] entries; 1e-5 to 1e3 */
} blob_blobs;

/* A model as arrays, which are read during blob_model_create() only. */
typedef struct blob_model_def {
  size_t node_count;
  const float (*centre)[3]; /* mm; within 1e6 of zero */
  const float* radius;      /* mm; 1e-5 to 1e3 */
  const int32_t* parent;    /* a node other than itself, or -1; null: no node has a parent */
  size_t link_count;        /* pairs of nodes that are joined besides parents and children */
  const uint32_t (*link)[2];
  blob_blobs blobs;
  blob_simd simd;
  uint32_t cookie; /* set by blob_model_def_default() */
} blob_model_def;

/* A definition without nodes, with the default kernel, parameter and iso-level.
 * Returns it; set at least node_count, centre, radius and blobs. Cannot fail. O(1). */
BLOB_API blob_model_def blob_model_def_default(void) BLOB_NOEXCEPT;

/* Builds a model from arrays.
 * The caller provides a definition from blob_model_def_default(), whose arrays it may free
 * afterwards.
 * On BLOB_OK *model is a model, to be closed by blob_model_close(); otherwise it is null.
 * Fails with BLOB_ERROR_MEMORY, _ARGUMENT, _EMPTY, _LIMIT, _RANGE, _TOPOLOGY or _KERNEL.
 * O(n log n). */
BLOB_API blob_status blob_model_create(const blob_model_def* def, blob_model** model) BLOB_NOEXCEPT;

/* Frees a model.
 * The caller provides a model that no query uses any more, or null, which does nothing.
 * Cannot fail. O(n). */
BLOB_API void blob_model_close(blob_model* model) BLOB_NOEXCEPT;

/* Properties of a model. */
typedef struct blob_model_info {
  size_t node_count, blob_count;
  blob_kernel kernel;
  double kernel_parameter, iso_level;
  blob_simd simd;         /* in use */
  double low[3], high[3]; /* box of the nodes' balls, mm */
  size_t bytes;           /* memory of the model; about 0.5 kB for each node of 8 blobs or fewer */
} blob_model_info;

/* Describes a model.
 * Returns its counts, kernel, box and memory. Cannot fail. O(log n). */
BLOB_API blob_model_info blob_model_describe(const blob_model* model) BLOB_NOEXCEPT;

/* One node of the tree. */
typedef struct blob_node {
  double centre[3], radius; /* mm */
  int32_t parent;           /* or -1 */
} blob_node;

/* Looks up a node.
 * The caller provides its index.
 * Returns its centre, radius and parent; for an index that is no node, NaN and -1. O(1). */
BLOB_API blob_node blob_model_node(const blob_model* model, uint32_t node) BLOB_NOEXCEPT;

/* Lists the neighbours of a node: the nodes that a cursor there may step to, and whose models may
 * blend with the node's own. Neighbours are the nodes one or two edges away (parents, children and
 * links are edges); and, at most four times the sum of both radii away along the tree, nodes whose
 * power cells meet this node's, or nearly meet, past the nodes between: in tight bends, in the
 * crotch of a bifurcation, beside nodes too thin to have cells of their own. The balls of such
 * nodes overlap, or the path along the tree is less than twice the straight distance. A node has at
 * most 32 neighbours besides its edges. The relation is symmetric.
 * The caller provides an index and room for `capacity` indices; null if that is 0.
 * Returns the number of neighbours, and writes the first `capacity`, ascending; 0 for an index that
 * is no node.
 * O(number of neighbours). */
BLOB_API size_t blob_model_neighbours(const blob_model* model, uint32_t node, uint32_t* neighbours,
                                      size_t capacity) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- cursor */

/* A cursor is the index of a node. Any value that is no node means "not known": the query
 * locates. */
#define BLOB_NOWHERE UINT32_MAX

/* Finds the node of least power |X - O|^2 - r^2 in the whole tree, the lowest index among equals.
 * Meant for a tool point that appears, not for every step: the search sees no walls, so a point in
 * a vessel that touches another is located in the nearer one.
 * The caller provides a point.
 * Returns the node; BLOB_NOWHERE for a point that is not finite. O(log n), by a bounding-volume
 * hierarchy. */
BLOB_API uint32_t blob_cursor_locate(const blob_model* model, const double point[3]) BLOB_NOEXCEPT;

/* Walks along the tree from the cursor's node: to the neighbour of least power (the lowest index
 * among equals) while that power is less than the node's own, at most 256 steps.
 * The caller provides a point and a cursor; one that is not known is located first.
 * Returns the node where the walk ends; the cursor itself for a point that is not finite or is
 * farther than 1e9 mm. O(steps); a point that moves less than a radius between queries needs none
 * or one. */
BLOB_API uint32_t blob_cursor_follow(const blob_model* model, const double point[3],
                                     uint32_t cursor) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- flags of queries */

/* Flags are added up; 0 is the default: blended, distance from one evaluation, the cursor follows.
 * Versions before 0.2 used the value 8, which stays free; unknown flags are ignored. */

/* The wall of the case: the models of the cursor's node and of neighbours that nearly tie with it,
 * weighted. With p_k the power of node k, tau_kj a width that belongs to a pair of neighbours, and
 * psi rising from 0 at -1 to 1 at 1 with two continuous derivatives,
 *     f = sum u_k f_k / sum u_k,
 *     u_k = product over k's neighbours j of psi((p_j - p_k) / tau_kj),
 * over the nodes with u_k > 0 that the cursor's node leads to. One model answers near the nodes of
 * a tube, two in the middle 60 % of the distance between them; at most 24 blend. The gradient is
 * the gradient of the blended f. So f is twice continuously differentiable where the kernel is
 * (Cauchy, Gaussian), along the tree and through bifurcations; distance and normal are once. A
 * vessel that merely touches has no influence. */
#define BLOB_BLENDED 0u

/* The model of the cursor's node answers alone, as in the thesis: an approximation, and the fastest
 * query. Within a node's power cell f is as smooth as the kernel; at the seam between two cells,
 * value and gradient jump by the models' disagreement (libblob/README.md, "Seams"). */
#define BLOB_LOCAL 1u

/* `distance` and `normal` refer to the nearest point of the wall, as blob_nearest() finds it,
 * instead of the one-evaluation form. */
#define BLOB_DISTANCE_EXACT 2u

/* The cursor does not move. With BLOB_LOCAL, one node's model answers anywhere. With blending, the
 * weights are meant for the node of least power: hold a cursor only while the point stays in its
 * power cell. Where no node has a weight, the cursor's own model answers. */
#define BLOB_HOLD 4u

/* ---------------------------------------------------------------- samples */

#define BLOB_INSIDE 1u        /* f > T */
#define BLOB_NOT_CONVERGED 2u /* an iteration met its bound on steps before its tolerance */

/* Result of a query at one point. */
typedef struct blob_sample {
  double value;       /* f, mm */
  double gradient[3]; /* grad f; points inwards */
  /* Signed distance to the wall, mm, negative in the lumen; negative exactly where f > T.
   *
   * One-evaluation form (default). With h a function of f that grows with the square of the
   * distance from the axis (Cauchy: f^-1/2, Gaussian: -ln f, compact kernels: -f^1/2) and R the
   * node's radius,
   *     c = ((h_T - h) + sqrt((h_T - h)^2 + R^2 |grad h|^2)) / (2 R^2),
   *     distance = |grad h| / (2 c) - R,
   * which is right to first order at the wall, -R on the axis, and grows like the distance far
   * outside. The distance is once continuously differentiable where f is twice. Outside, where grad
   * f nearly vanishes between two parts of a vessel, it is cut at the distance to the far side of
   * the node's ball. Where f vanishes (outside a compact kernel's support) it is the distance to
   * the node's ball, or 0.
   *
   * BLOB_DISTANCE_EXACT: the distance to the nearest point of the wall, found as by blob_nearest()
   * with an error of 1e-5 R; continuous, with a kink where two points of the wall are equally near.
   * A few points, mostly near an axis, end with BLOB_NOT_CONVERGED and the nearest point so far. */
  double distance;
  /* Outward unit normal, -grad f / |grad f|; zero where grad f is zero; away from the node's centre
   * where f vanishes. With BLOB_DISTANCE_EXACT: the normal at the nearest point of the wall. */
  double normal[3];
  uint32_t node;  /* the cursor after the query */
  uint32_t state; /* BLOB_INSIDE and BLOB_NOT_CONVERGED */
} blob_sample;

/* Evaluates f, its gradient, distance and normal at one point.
 * The caller provides flags, a point and its cursor, which is read and moved; null: the point is
 * located, which costs more than the query.
 * *sample is the answer. Cannot fail.
 * O(b), times the number of nodes that blend; with BLOB_DISTANCE_EXACT some tens of evaluations. */
BLOB_API void blob_query(const blob_model* model, uint32_t flags, const double point[3],
                         uint32_t* cursor, blob_sample* sample) BLOB_NOEXCEPT;

/* Evaluates blob_query() at many points, faster than one by one.
 * The caller provides `count` points, packed, one cursor for each, which are read and moved, and
 * room for one sample for each. `cursors` may be null: each point is located. All may be null if
 * `count` is 0.
 * samples[i] has the bits of a single query of points[i]. Cannot fail.
 * O(count) queries. */
BLOB_API void blob_query_many(const blob_model* model, uint32_t flags, size_t count,
                              const double (*points)[3], uint32_t* cursors,
                              blob_sample* samples) BLOB_NOEXCEPT;

/* Points and answers as strided columns: a structure of arrays (strides of one number) or any array
 * of structures. Element i of a column is at its pointer plus i * stride bytes, of any alignment.
 * Null columns of answers are not written. An answer may be written over a column of points of the
 * same pointer and stride. */
typedef struct blob_columns {
  size_t count;
  const double* point[3];
  ptrdiff_t point_stride;  /* bytes; default sizeof(double) */
  uint32_t* cursor;        /* may be null: each point is located */
  ptrdiff_t cursor_stride; /* bytes; default sizeof(uint32_t) */
  double* value;
  double* gradient[3];     /* all three or none */
  double* distance;
  double* normal[3];       /* all three or none */
  ptrdiff_t answer_stride; /* bytes, of the columns of doubles; default sizeof(double) */
  uint8_t* state;          /* BLOB_INSIDE and BLOB_NOT_CONVERGED */
  ptrdiff_t state_stride;  /* bytes; default 1 */
} blob_columns;

/* Columns without data, with the default strides.
 * Returns them; set count, point and the answers that are wanted. Cannot fail. O(1). */
BLOB_API blob_columns blob_columns_default(void) BLOB_NOEXCEPT;

/* Evaluates blob_query() at many points in the caller's own layout.
 * The caller provides columns from blob_columns_default(), with points, and cursors that are read
 * and moved.
 * The columns of answers that are not null are filled, with the bits of single queries.
 * Cannot fail. O(count) queries. */
BLOB_API void blob_query_columns(const blob_model* model, uint32_t flags,
                                 const blob_columns* columns) BLOB_NOEXCEPT;

/* Tests whether a point is in the lumen.
 * The caller provides flags, a point and its cursor, as for blob_query().
 * Returns 1 if f > T, else 0. Cannot fail.
 * O(b), times the number of nodes that blend; no distance and no normal are computed. */
BLOB_API int blob_inside(const blob_model* model, uint32_t flags, const double point[3],
                         uint32_t* cursor) BLOB_NOEXCEPT;

/* The nearest point of the wall. */
typedef struct blob_nearest_point {
  double point[3];
  double normal[3]; /* outward, at `point` */
  double distance;  /* signed: negative if the query point is inside */
  uint32_t node;    /* the node of `point`; the caller's cursor follows the query point only */
  uint32_t steps;   /* evaluations made */
  int converged;    /* 0: the bound on steps was met; `point` is the best so far */
} blob_nearest_point;

/* Finds the nearest point of the wall: Newton's method on h (see blob_sample.distance) to the wall
 * and along it until the line to the query point is the normal. The result is a local minimum of
 * the distance; on the axis of a tube, where a ring of points is equally near, it is one of them.
 * The caller provides flags, a point and its cursor, as for blob_query(); a tolerance in mm
 * (0: 1e-5 of the node's radius); and a bound on evaluations (0: 40).
 * *nearest is the answer; converged = 0 if the bound was met first. Cannot fail.
 * O(max_steps) evaluations, some of them with second derivatives; three for most points. */
BLOB_API void blob_nearest(const blob_model* model, uint32_t flags, const double point[3],
                           uint32_t* cursor, double tolerance, uint32_t max_steps,
                           blob_nearest_point* nearest) BLOB_NOEXCEPT;

/* f and its first and second derivatives, in doubles throughout. */
typedef struct blob_hessian {
  double value;       /* f, mm */
  double gradient[3]; /* grad f */
  double hessian[6];  /* xx, yy, zz, xy, xz, yz of f, 1/mm */
  /* Curvatures of the level set of f through the point: (k1 + k2) / 2, 1/mm, and k1 k2, 1/mm^2.
   * Principal curvatures are positive where the surface bends away from its outward normal (a lumen
   * of radius r: 1/r along the ring). NaN where grad f is zero. */
  double mean_curvature, gaussian_curvature;
} blob_hessian;

/* Evaluates f, its gradient, its Hessian and the curvatures of its level set.
 * The caller provides flags, a point and its cursor, as for blob_query().
 * *answer is the answer. Cannot fail.
 * O(b), times the number of nodes that blend; scalar code, several times slower than
 * blob_query(). */
BLOB_API void blob_query_hessian(const blob_model* model, uint32_t flags, const double point[3],
                                 uint32_t* cursor, blob_hessian* answer) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- segments, for tools */

/* First crossing of a segment with the wall. */
typedef struct blob_hit {
  int hit;          /* 1: the segment crosses the wall at `t`; 0: no crossing, or steps ran out */
  int complete;     /* 0: the bound on steps was met at `t`; there is no crossing before */
  double t;         /* fraction of the path from `from` to `to` */
  double point[3];  /* at t */
  double normal[3]; /* outward, at `point` */
  uint32_t node;    /* cursor at `point` */
  uint32_t steps;   /* evaluations made */
} blob_hit;

/* Finds the first crossing of the wall, outwards or inwards, on the path from `from` to `to`, by
 * sphere tracing: steps are as long as bounds on f in balls around the path allow, and no shorter
 * than the tolerance, so the only crossings missed are those that reverse within that length. A
 * segment that leaves its vessel into one that touches is a hit, however thin the gap.
 * The caller provides flags, both ends, and the cursor of `from`, which is moved to `from` only (a
 * copy of it follows the tree along the path); a tolerance in mm (0: 1e-3 of the node's radius);
 * and a bound on evaluations (0: 16384).
 * *hit is the answer; its t is right to the tolerance, on the side of `from`. complete = 0 if the
 * bound was met first. An end that is not finite gives NaN and no hit. Cannot fail.
 * O(steps) evaluations; only a segment that grazes the wall over a long distance needs more than
 * some tens. */
BLOB_API void blob_segment_hit(const blob_model* model, uint32_t flags, const double from[3],
                               const double to[3], uint32_t* cursor, double tolerance,
                               uint32_t max_steps, blob_hit* hit) BLOB_NOEXCEPT;

/* Deepest point of a capsule's axis: where it is closest to leaving the lumen. */
typedef struct blob_approach {
  double t;         /* fraction of the path from `from` to `to` at `point` */
  double point[3];  /* the deepest point of the axis */
  double distance;  /* signed, mm, of `point`; the capsule touches if distance + radius > 0 */
  double normal[3]; /* outward unit normal at `point`; push the capsule along -normal */
  double depth;     /* distance + radius, mm */
  uint32_t node;    /* cursor at `point` */
  uint32_t state;   /* BLOB_INSIDE (for `point`) and BLOB_NOT_CONVERGED */
} blob_approach;

/* Finds the point of a capsule's axis that has the greatest distance, by samples no more than a
 * quarter of the local radius apart (at most 128) and a golden-section search between them.
 * The caller provides flags, both ends of the axis, the radius in mm, and the cursor of `from`,
 * which is moved to `from` only. A chain of capsules passes one array of cursors.
 * *approach is the answer. An end that is not finite gives NaN. Cannot fail.
 * O(length / radius) evaluations, and 16 more. */
BLOB_API void blob_capsule_approach(const blob_model* model, uint32_t flags, const double from[3],
                                    const double to[3], double radius, uint32_t* cursor,
                                    blob_approach* approach) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- other processors */

/* Packs models into one flat buffer, from which the functions of blob_device.h answer on a graphics
 * processor. blob_device.h states the layout.
 * The caller provides `count` models, at least one, and `capacity` bytes at `buffer`, aligned to 4
 * (64 for fastest access); null if `capacity` is 0.
 * Returns the bytes that the models take, and writes them if `capacity` suffices. Returns 0 for no
 * model, and for models that take 16 GiB or more.
 * O(bytes). */
BLOB_API size_t blob_device_pack(const blob_model* const* models, size_t count, void* buffer,
                                 size_t capacity) BLOB_NOEXCEPT;

/* Checks a buffer of blob_device_pack() that came from elsewhere: the functions of blob_device.h read
 * nothing outside of a buffer that passes, for any point and cursor.
 * The caller provides `size` bytes, aligned to 4.
 * Returns BLOB_OK, or BLOB_ERROR_ARGUMENT (null), _FORMAT (another version, size or layout), _EMPTY,
 * _LIMIT, _KERNEL, _RANGE (a number that no case has) or _TOPOLOGY (an index without its element).
 * O(size). */
BLOB_API blob_status blob_device_check(const void* buffer, size_t size) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- misuse */

/* Handler of misuse: receives the broken condition and its place in the source. */
typedef void (*blob_misuse_handler)(const char* condition, const char* file, int line);

/* Sets the handler of misuse, in builds without NDEBUG, for all models and threads.
 * The caller provides a handler; null restores the default, which prints nothing and aborts.
 * Cannot fail. O(1). */
BLOB_API void blob_set_misuse_handler(blob_misuse_handler handler) BLOB_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#endif
