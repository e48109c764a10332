/* SPDX-License-Identifier: Apache-2.0
 *
 * libblob: signed distance, gradient and inside test of a vessel tree, for simulators. C99 and C++11.
 *
 * A vessel tree is a set of nodes along centerlines. Each node has a centre, a radius and its own smooth
 * implicit surface, a sum of a few blobs (A. Yureidini, Robust blood vessel surface reconstruction for
 * interactive simulations from patient data, 2014):
 *
 *     f(X) = sum over the node's blobs j of  w_j * phi(|X - C_j|^2 / w_j^2)
 *
 * The wall is f = T (the iso-level), the lumen is f > T, and f falls outwards. A tool point remembers its
 * node, its cursor, and moves it along the tree only, never across space: two vessels that touch stay two
 * vessels. So a query looks at one node, or at a few where models are blended, however large the tree is.
 *
 * In short:
 *
 *     blob_model* vessel;
 *     if (blob_model_open("head.lumen", NULL, &vessel) != BLOB_OK) return 1;
 *     uint32_t cursor = BLOB_NOWHERE;            // one per tool point, kept from step to step
 *     blob_sample s;
 *     blob_query(vessel, 0, point, &cursor, &s); // s.distance < 0: inside; s.normal points outwards
 *     blob_model_close(vessel);
 *
 * Units and frame. Lengths are millimetres, in the frame of the case: LPS (+x left, +y posterior, +z
 * superior). f and T are lengths, grad f has no unit.
 *
 * Sign. Distances are negative in the lumen. MuJoCo's signed distance fields, SOFA's distance grids and
 * Bullet's are positive where a tool may move: negate.
 *
 * Threads. A model does not change after construction; any number of threads may query it. Nothing else
 * is shared but the handler of blob_set_misuse_handler().
 *
 * Queries never allocate, lock, log or throw, and are defined for every point: a NaN coordinate gives NaN
 * numbers, "outside" and an unmoved cursor; an infinite one gives f = 0, an infinite distance, a zero
 * normal and "outside". Null pointers (where not allowed) and closed models are misuse: a call to the
 * misuse handler in debug builds, undefined otherwise.
 *
 * Arithmetic. Points are doubles. Within a node's neighbourhood the work is done in floats relative to
 * the node's centre, a relative error of some 1e-6. Every SIMD path gives the same bits as the scalar one
 * on every machine (BLOB_DISTANCE_EXACT also calls the C library's hypot, sin and cos: the last bits are
 * that library's), batches give the bits of single queries, and no result depends on the number of
 * threads.
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
#define BLOB_VERSION_MINOR 1
#define BLOB_VERSION_PATCH 0

/* ---------------------------------------------------------------- status */

/* What a construction answers. Values are only appended. */
typedef enum blob_status {
  BLOB_OK = 0,
  BLOB_ERROR_MEMORY = 1,     /* the system has no more memory */
  BLOB_ERROR_ARGUMENT = 2,   /* a null pointer, or a definition not made by blob_model_def_default() */
  BLOB_ERROR_FILE = 3,       /* the file cannot be opened, read or mapped */
  BLOB_ERROR_FORMAT = 4,     /* the bytes are not a .lumen file, or break a rule of the format */
  BLOB_ERROR_CHECKSUM = 5,   /* a chunk's bytes do not match their checksum */
  BLOB_ERROR_ENCODING = 6,   /* a chunk that is needed is stored compressed; convert the file to raw */
  BLOB_ERROR_NO_MODELS = 7,  /* the case has no models: fit it first */
  BLOB_ERROR_EMPTY = 8,      /* no node */
  BLOB_ERROR_LIMIT = 9,      /* more nodes, blobs or links than the limits below */
  BLOB_ERROR_RANGE = 10,     /* a number is not finite or out of its range, see blob_model_def */
  BLOB_ERROR_TOPOLOGY = 11,  /* a parent, link or offset names what does not exist */
  BLOB_ERROR_KERNEL = 12     /* no such kernel */
} blob_status;

/* One English sentence without a full stop, static and never null, for any value. */
BLOB_API const char* blob_status_text(blob_status status) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- model */

/* An immutable vessel tree with its blobs. */
typedef struct blob_model blob_model;

/* phi(x) of x = |X - C|^2 / w^2. Values are those of the file format. */
typedef enum blob_kernel {
  BLOB_CAUCHY = 0,     /* (1 + p x)^-2; infinite support; p = kernel_parameter, usually 0.2 */
  BLOB_GAUSSIAN = 1,   /* exp(-p x); infinite support; usually 0.5; the slowest: eight exponentials a block */
  BLOB_QUARTIC = 2,    /* (1 - x)^2 for x < 1, else 0 */
  BLOB_SOFT_OBJECT = 3 /* 1 - (4/9) x^3 + (17/9) x^2 - (22/9) x for x < 1, else 0 */
} blob_kernel;

/* Which instructions a model's queries use. All give the same bits. */
typedef enum blob_simd {
  BLOB_SIMD_BEST = 0,     /* the best that this processor has */
  BLOB_SIMD_SCALAR = 1,   /* the reference */
  BLOB_SIMD_PORTABLE = 2, /* the compiler's vectors for the build's target: SSE2, NEON, WebAssembly SIMD */
  BLOB_SIMD_AVX2 = 3,
  BLOB_SIMD_AVX512 = 4
} blob_simd;

#define BLOB_MAX_NODES 16777216u /* 2^24, as the file format */
#define BLOB_MAX_BLOBS 67108864u /* 2^26 */
#define BLOB_MAX_LINKS 16777216u

/* How to open. Get one from blob_open_def_default(), then change fields. */
typedef struct blob_open_def {
  int verify;          /* 1 (default): every checksum and value; 0: only sizes and what queries rely on */
  blob_simd simd;      /* BLOB_SIMD_BEST; a path that the processor lacks falls back to the next below */
  char* message;       /* null, or where a sentence about a failure goes, zero-terminated */
  size_t message_size; /* bytes at `message` */
  uint32_t cookie;     /* set by blob_open_def_default() */
} blob_open_def;

BLOB_API blob_open_def blob_open_def_default(void) BLOB_NOEXCEPT;

/* Opens the .lumen file at `path` (UTF-8). The file is mapped, read in place and released again. `def`
 * may be null: the defaults. On BLOB_OK, *model is a model to be closed; otherwise null. Costs about 1 us
 * for each node. */
BLOB_API blob_status blob_model_open(const char* path, const blob_open_def* def,
                                     blob_model** model) BLOB_NOEXCEPT;

/* The same from `size` bytes in memory, of any alignment, that the caller owns. They are read in place,
 * not copied, and not needed after the call: what queries read is laid out anew, in blocks for SIMD. */
BLOB_API blob_status blob_model_open_bytes(const void* bytes, size_t size, const blob_open_def* def,
                                           blob_model** model) BLOB_NOEXCEPT;

/* The blobs of all nodes, node i owning offset[i] .. offset[i + 1] - 1. */
typedef struct blob_blobs {
  blob_kernel kernel;      /* default BLOB_CAUCHY */
  double kernel_parameter; /* default 0.2; 1e-4 to 1e4; not used by the compact kernels */
  double iso_level;        /* T, mm; default 0.1; 1e-6 to 1e3 */
  const uint32_t* offset;  /* node_count + 1 entries, from 0, not decreasing; a node without blobs answers
                              with those of the nearest node along the tree that has some, and is outside
                              everywhere (f = 0) if there is none */
  const float (*centre)[3]; /* mm, offset[node_count] entries; within 1e6 of zero */
  const float* width;       /* mm, as many; 1e-5 to 1e3 */
} blob_blobs;

/* A model from arrays, which are read during blob_model_create() only. Get one from
 * blob_model_def_default(), then set at least node_count, centre, radius and blobs. */
typedef struct blob_model_def {
  size_t node_count;
  const float (*centre)[3]; /* mm; within 1e6 of zero */
  const float* radius;      /* mm; 1e-5 to 1e3 */
  const int32_t* parent;    /* a node other than itself, or -1; null: no node has a parent */
  size_t link_count;        /* pairs of nodes that are neighbours besides parents and children */
  const uint32_t (*link)[2];
  blob_blobs blobs;
  const blob_blobs* twin; /* null, or a compact twin for BLOB_TWIN; a kernel of any kind */
  blob_simd simd;
  uint32_t cookie; /* set by blob_model_def_default() */
} blob_model_def;

BLOB_API blob_model_def blob_model_def_default(void) BLOB_NOEXCEPT;

BLOB_API blob_status blob_model_create(const blob_model_def* def, blob_model** model) BLOB_NOEXCEPT;

/* Frees a model; null is allowed. */
BLOB_API void blob_model_close(blob_model* model) BLOB_NOEXCEPT;

typedef struct blob_model_info {
  size_t node_count, blob_count;
  blob_kernel kernel;
  double kernel_parameter, iso_level;
  int has_twin;
  blob_simd simd;      /* the path in use */
  double low[3], high[3]; /* box of the nodes' balls, mm */
  size_t bytes;        /* memory of the model; about 0.5 kB for each node of 8 blobs or fewer */
} blob_model_info;

BLOB_API blob_model_info blob_model_describe(const blob_model* model) BLOB_NOEXCEPT;

/* Centre (mm) and radius (mm) of a node; its parent, or -1. A node that does not exist gives NaN and -1. */
typedef struct blob_node {
  double centre[3], radius;
  int32_t parent;
} blob_node;

BLOB_API blob_node blob_model_node(const blob_model* model, uint32_t node) BLOB_NOEXCEPT;

/* The neighbours that a cursor at `node` may step to: those one or two edges away (parents, children and
 * links are edges), and, up to four times the sum of both radii away along the tree, nodes whose cells of
 * least power meet this one's past the nodes between: in tight bends, in the crotch of a bifurcation, beside
 * nodes too thin to have cells of their own. Such nodes' balls overlap, or the way along the tree is at most
 * twice the straight one. At most 32 besides the edges. Symmetric.
 * Writes the first `capacity` of them, returns their number. */
BLOB_API size_t blob_model_neighbours(const blob_model* model, uint32_t node, uint32_t* neighbours,
                                      size_t capacity) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- cursor */

/* A cursor is the index of a node. Any value that is no node means "not known": the query locates. */
#define BLOB_NOWHERE UINT32_MAX

/* The node of least power |X - O|^2 - r^2 in the whole tree, the lowest index among equals; BLOB_NOWHERE
 * for a point that is not finite. Through a tree of boxes: about 0.2 to 1 us for 10,000 nodes. Use it when a
 * tool point appears, not in every step: it sees no walls, so a point in a vessel that touches another is
 * located in whichever is nearer. */
BLOB_API uint32_t blob_cursor_locate(const blob_model* model, const double point[3]) BLOB_NOEXCEPT;

/* Walks from `cursor` to the neighbour of least power while the power falls, at most 256 steps. A point
 * that moves less than a radius from query to query needs none or one. */
BLOB_API uint32_t blob_cursor_follow(const blob_model* model, const double point[3],
                                     uint32_t cursor) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- queries */

/* Flags of queries; 0 is the default: blended, distance from one evaluation, cursor follows. */

/* The cursor's node alone answers, as in the thesis. Fastest. Within a node's cell all is as smooth as the
 * kernel; at the seam between two cells value and gradient jump by the models' disagreement, commonly some
 * hundredths of a millimetre in distance. */
#define BLOB_LOCAL 1u

/* Default. The models of the cursor's node and its neighbours, weighted by smooth functions of their
 * differences of power: u_k = product over k's neighbours j of psi((p_k - p_j) / tau_kj), psi falling from
 * 1 to 0 between -1 and 1 with two continuous derivatives, f = sum u_k f_k / sum u_k. One model answers
 * near the nodes of a tube, two in the middle 60 % of the way between them. So f is twice continuously
 * differentiable where the kernel is (Cauchy, Gaussian), along the tree and through bifurcations, distance
 * and normal once; the gradient is the blended f's own. A vessel that merely touches has no influence.
 *
 * Measured (seam_sweep, LOCAL in brackets). On two fitted synthetic trees of 40 vessels nothing jumps: value,
 * gradient and distance by at most 5e-8, 6e-7 and 3e-7 at 65,854 seams (0.11 mm, 0.72, 0.48 mm), and
 * elsewhere on the same lines by no more than rounding. On a real angiogram with vessels of one voxel, 13 of
 * 44,493 seams jump, one within the radius of the cursor's node; of 347,987 steps at seams and elsewhere 39
 * jump, 7 of them within that radius: where an aneurysm lies against the vessel that it hangs on, or a
 * vessel's course turns back on itself. At most 24 models blend.
 */
#define BLOB_BLENDED 0u

/* `distance` and `normal` are those of the nearest point of the wall, as blob_nearest() finds it, instead
 * of the one-evaluation form. */
#define BLOB_DISTANCE_EXACT 2u

/* The cursor stays where it is. For BLOB_LOCAL: one node's model anywhere. With blending, the weights are
 * meant for the node of least power: hold a cursor only while the point stays in its cell. */
#define BLOB_HOLD 4u

/* Answer from the compact twin where the model has one, else from the model. The twin's surface is another
 * fit of the same vessel: near the wall the two may differ by their errors of fit. */
#define BLOB_TWIN 8u

/* What is known at a point. */
typedef struct blob_sample {
  double value;       /* f, mm */
  double gradient[3]; /* grad f; points inwards */
  /* Signed distance to the wall, mm, negative in the lumen; negative exactly where f > T.
   *
   * One-evaluation form (default). With h a function of f that grows with the square of the distance from
   * the axis (Cauchy: f^-1/2, Gaussian: -ln f, compact kernels: -f^1/2) and R the node's radius,
   *     c = ((h_T - h) + sqrt((h_T - h)^2 + R^2 |grad h|^2)) / (2 R^2),  distance = |grad h| / (2 c) - R,
   * which is right to first order at the wall, -R on the axis, and grows like the distance far outside.
   * Where f vanishes (outside a compact kernel's support) it is the distance to the node's ball, or 0.
   * Error against BLOB_DISTANCE_EXACT, in radii, on a fitted tree of 2,220 nodes, blended; median and 99 %
   * of points at distance d:
   *     |d| < 0.05 R  0.0001  0.001        0.2 R to 0.4 R outside  0.011  0.06
   *     |d| < 0.2 R   0.002   0.017        0.4 R to 0.7 R outside  0.033  0.16
   *     to 0.4 R deep 0.010   0.08         0.7 R to 1 R outside    0.07   0.27
   *     to 0.8 R deep 0.028   0.24         the axis                0.05   0.37 (bifurcations, aneurysm)
   * Cost on one core of an AMD EPYC (Zen 4): 14 ns LOCAL, 42 ns BLENDED in batches; 33 and 65 ns
   * alone. It is once continuously differentiable where f is twice. Outside, where grad f nearly vanishes
   * between two parts of a vessel, it is cut at the
   * distance to the far side of the node's ball.
   *
   * BLOB_DISTANCE_EXACT: the distance to the nearest point of the wall, found as by blob_nearest(). Error
   * 1e-5 R; cost 1 to 2.5 us; continuous, with a kink where two points of the wall are equally near. About
   * 2 points in 1000, mostly near an axis, end with BLOB_NOT_CONVERGED and the nearest point so far. */
  double distance;
  /* Outward unit normal, -grad f / |grad f|; zero where grad f is zero; away from the node's centre where f
   * vanishes. With BLOB_DISTANCE_EXACT that of the nearest point of the wall. */
  double normal[3];
  uint32_t node;  /* the cursor after the query */
  uint32_t state; /* BLOB_INSIDE and BLOB_NOT_CONVERGED */
} blob_sample;

#define BLOB_INSIDE 1u        /* f > T */
#define BLOB_NOT_CONVERGED 2u /* an iteration met its bound on steps before its tolerance */

/* One point. `cursor` is read and moved; null: located, which costs more than the query. */
BLOB_API void blob_query(const blob_model* model, uint32_t flags, const double point[3],
                         uint32_t* cursor, blob_sample* sample) BLOB_NOEXCEPT;

/* `count` points, packed; one cursor and one sample for each. `cursors` may be null: each point is located. */
BLOB_API void blob_query_many(const blob_model* model, uint32_t flags, size_t count,
                              const double (*points)[3], uint32_t* cursors,
                              blob_sample* samples) BLOB_NOEXCEPT;

/* Points and answers as strided columns: structure of arrays (strides of one number) or any array of
 * structures. Element i of a column is at its pointer plus i * stride bytes, of any alignment. Columns of
 * answers may be null: not wanted. In place: an answer may be written over a column of points of the same
 * pointer and stride. */
typedef struct blob_columns {
  size_t count;
  const double* point[3];
  ptrdiff_t point_stride; /* bytes; default sizeof(double) */
  uint32_t* cursor;       /* may be null: each point is located */
  ptrdiff_t cursor_stride; /* bytes; default sizeof(uint32_t) */
  double* value;
  double* gradient[3]; /* all three or none */
  double* distance;
  double* normal[3];       /* all three or none */
  ptrdiff_t answer_stride; /* bytes, of the columns of doubles; default sizeof(double) */
  uint8_t* state;          /* BLOB_INSIDE and BLOB_NOT_CONVERGED */
  ptrdiff_t state_stride;  /* bytes; default 1 */
} blob_columns;

BLOB_API blob_columns blob_columns_default(void) BLOB_NOEXCEPT;

BLOB_API void blob_query_columns(const blob_model* model, uint32_t flags,
                                 const blob_columns* columns) BLOB_NOEXCEPT;

/* 1 if f > T, else 0: value only, no gradient. With BLOB_TWIN and a compact twin the cheapest query. */
BLOB_API int blob_inside(const blob_model* model, uint32_t flags, const double point[3],
                         uint32_t* cursor) BLOB_NOEXCEPT;

/* The nearest point of the wall. */
typedef struct blob_nearest_point {
  double point[3];
  double normal[3]; /* outward, at `point` */
  double distance;  /* signed: negative if the query point is inside */
  uint32_t node;    /* the node that `point` lies in; the caller's cursor follows the query point only */
  uint32_t steps;   /* evaluations made */
  int converged;    /* 0: the bound on steps was met; `point` is the best so far */
} blob_nearest_point;

/* Newton's method on h (see blob_sample.distance) to the wall, then along it until the way back to the
 * query point is the normal, to `tolerance` mm (0: 1e-5 of the node's radius), in at most `max_steps`
 * evaluations with second derivatives (0: 40). The point found is a nearest one of its surroundings: on
 * the axis of a tube, where a ring of points is equally near, one of them. */
BLOB_API void blob_nearest(const blob_model* model, uint32_t flags, const double point[3],
                           uint32_t* cursor, double tolerance, uint32_t max_steps,
                           blob_nearest_point* nearest) BLOB_NOEXCEPT;

/* Second derivatives, in doubles throughout. */
typedef struct blob_second {
  double value;       /* f, mm */
  double gradient[3]; /* grad f */
  double hessian[6];  /* xx, yy, zz, xy, xz, yz of f, 1/mm */
  /* Of the level set of f through the point, 1/mm: (k1 + k2) / 2 and k1 k2, principal curvatures counted
   * positive where the surface bends away from its outward normal (a lumen of radius r: 1/r along the
   * ring). NaN where grad f is zero. */
  double mean_curvature, gaussian_curvature;
} blob_second;

BLOB_API void blob_query_second(const blob_model* model, uint32_t flags, const double point[3],
                                uint32_t* cursor, blob_second* second) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- segments, for tools */

typedef struct blob_hit {
  int hit;          /* 1: the segment crosses the wall at `t`; 0: it does not, or steps ran out at `t` */
  int complete;     /* 0: the bound on steps was met at `t`; up to there is no crossing */
  double t;         /* share of the way from `from` to `to` */
  double point[3];  /* at t */
  double normal[3]; /* outward, at `point` */
  uint32_t node;    /* cursor at `point` */
  uint32_t steps;   /* evaluations made */
} blob_hit;

/* The first crossing of the wall, outwards or inwards, on the way from `from` to `to`. The cursor belongs
 * to `from` and is moved to `from` only; on the way a copy of it follows the tree, so that a segment which
 * leaves its vessel into one that touches is a hit, however thin the gap. Steps are as long as bounds on f
 * in balls around the path allow, and no shorter than `tolerance` mm (0: 1e-3 of the node's radius): no
 * crossing is missed but those that go back within that length. `t` is right to the tolerance, on the
 * side of `from`. At most `max_steps` evaluations (0: 16384); only a
 * segment that grazes the wall for a long way needs more than some tens. */
BLOB_API void blob_segment_hit(const blob_model* model, uint32_t flags, const double from[3],
                               const double to[3], uint32_t* cursor, double tolerance,
                               uint32_t max_steps, blob_hit* hit) BLOB_NOEXCEPT;

typedef struct blob_approach {
  double t;         /* share of the way from `from` to `to` of the deepest point of the axis */
  double point[3];  /* that point of the axis */
  double distance;  /* its signed distance to the wall, mm; distance + radius > 0: the capsule touches */
  double normal[3]; /* outward unit normal there; push the capsule along -normal */
  double depth;     /* distance + radius, mm */
  uint32_t node;    /* cursor at `point` */
  uint32_t state;   /* BLOB_INSIDE: of `point`; BLOB_NOT_CONVERGED */
} blob_approach;

/* Where a capsule (axis `from` to `to`, `radius` mm) comes closest to leaving the lumen: the axis point of
 * the greatest distance, by samples no more than a quarter of the local radius apart (at most 128) and a
 * search between them. `cursor` belongs to `from`. A chain of capsules passes one array of cursors. */
BLOB_API void blob_capsule_approach(const blob_model* model, uint32_t flags, const double from[3],
                                    const double to[3], double radius, uint32_t* cursor,
                                    blob_approach* approach) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- misuse */

/* Called in builds without NDEBUG with the broken condition and its place; the default prints nothing and
 * aborts. Null restores the default. */
typedef void (*blob_misuse_handler)(const char* condition, const char* file, int line);
BLOB_API void blob_set_misuse_handler(blob_misuse_handler handler) BLOB_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#endif
