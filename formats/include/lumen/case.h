/* SPDX-License-Identifier: Apache-2.0
 *
 * Cases of lumen, read, validated and written (C99, C++11). lumen/case_edit.h changes them,
 * lumen/case.hpp wraps both for C++17.
 *
 * A case is a tree of vessels: nodes along centerlines with radii, named branches of nodes, and
 * optionally points on the wall and smooth implicit models (spec/lumen.md). It is stored as .lumen
 * (binary) or .lumen.json (its lossless twin).
 *
 * In short:
 *
 *     lumen_case* head;
 *     lumen_case_fault fault;
 *     if (lumen_case_open("head.lumen", &head, &fault) != LUMEN_CASE_OK) {
 *       puts(fault.message);                  // head.lumen: RADIUS_RANGE at byte 128: found -1, ...
 *       return 1;
 *     }
 *     lumen_case_nodes nodes = lumen_case_get_nodes(head);
 *     for (size_t i = 0; i < nodes.count; ++i) printf("%g\n", nodes.radius[i]);
 *     lumen_case_close(head);
 *
 * How to read this header. Each function's comment states the work, the caller's arguments, the
 * result, failures and the cost. n is the size of a case: its nodes, wall points and blobs.
 *
 * Units and frame. Lengths are millimetres, positions and directions are LPS patient coordinates:
 * +x left, +y posterior, +z superior. Arrays of positions have the shape [count][3].
 *
 * Validity. A case that was opened is valid. Every edit leaves a valid case, or fails and leaves
 * the case as it was. A case of lumen_case_create() has no node until lumen_case_set_tree(), and
 * is the only one that cannot be written.
 *
 * Failure. Functions that can fail return a status, and describe the reason in *fault unless that
 * is null. The rules and their numbers are those of spec/errors.md. No function prints, exits or
 * throws. Functions without a status cannot fail; an index that does not exist gives zeros, NaN
 * and null.
 *
 * Life of pointers. Arrays and texts of a case stay where they are until the case is edited or
 * closed. Texts are UTF-8, end with a zero, and are never null in a struct that exists.
 *
 * Threads. Any number of threads may read one case. An edit excludes all other calls with the same
 * case. Different cases do not affect each other.
 *
 * Compatibility. Programs that were linked with liblumen-case.so.1 run with every later one of that
 * number: functions, and values of enumerations, are only added; structs do not change.
 */
#ifndef LUMEN_CASE_H
#define LUMEN_CASE_H

/* Comments stand in columns. */
/* clang-format off */

#include <stddef.h>
#include <stdint.h>

#if defined(LUMEN_CASE_STATIC) || defined(_WIN32)
#define LUMEN_CASE_CALL
#else
#define LUMEN_CASE_CALL __attribute__((visibility("default")))
#endif
#ifdef __cplusplus
#define LUMEN_CASE_NOEXCEPT noexcept
extern "C" {
#else
#define LUMEN_CASE_NOEXCEPT
#endif

/* Number of the interface. It grows when functions are added. */
#define LUMEN_CASE_INTERFACE 2

/* Version of the library that runs, such as "0.2.0". Static. Cannot fail. O(1). */
LUMEN_CASE_CALL const char* lumen_case_version(void) LUMEN_CASE_NOEXCEPT;

/* ---------------------------------------------------------------- status */

/* Result of a call. Values are only appended. */
typedef enum lumen_case_status {
  LUMEN_CASE_OK = 0,
  LUMEN_CASE_ERROR_MEMORY = 1,   /* the system has no more memory */
  LUMEN_CASE_ERROR_ARGUMENT = 2, /* a null pointer, an index that does not exist, a bad option */
  LUMEN_CASE_ERROR_FILE = 3,     /* the file cannot be read, or is empty */
  LUMEN_CASE_ERROR_RULE = 4,     /* bytes or values break a rule of the format: see the fault */
  LUMEN_CASE_ERROR_WRITE = 5     /* the file cannot be written; an old one is untouched */
} lumen_case_status;

/* Describes a status.
 * Takes any value, also one that is no status.
 * Returns one English sentence without a full stop, static, never null. O(1). */
LUMEN_CASE_CALL const char* lumen_case_status_text(lumen_case_status status) LUMEN_CASE_NOEXCEPT;

typedef enum lumen_case_severity {
  LUMEN_CASE_ERROR = 0,      /* the case is refused */
  LUMEN_CASE_WARNING = 1,    /* legal, but not what a writer should write */
  LUMEN_CASE_INFORMATION = 2 /* legal, and worth knowing */
} lumen_case_severity;

/* A broken rule and its place. Texts that are too long are cut off at a whole character. */
typedef struct lumen_case_fault {
  int32_t code; /* number of the rule; 0: no rule, such as for a null pointer */
  lumen_case_severity severity;
  char name[32];     /* of the rule, such as "RADIUS_RANGE"; empty without a rule */
  char place[256];   /* "byte 128", or a JSON pointer such as "/tree/radius/0" */
  char message[512]; /* one line for people, with name and place */
} lumen_case_fault;

/* ---------------------------------------------------------------- reading */

/* A case in memory. */
typedef struct lumen_case lumen_case;

/* Reads a case from a file of either encoding, whatever its name, and validates it.
 * The caller provides a path (UTF-8), and room for a fault or null.
 * On LUMEN_CASE_OK *out is a case, to be closed by lumen_case_close(); otherwise it is null.
 * Fails with MEMORY, ARGUMENT, FILE or RULE. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_open(const char* path, lumen_case** out,
                                                  lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Reads a case from the bytes of a file of either encoding.
 * The caller provides `size` bytes, which are read during the call only.
 * Result and failures are those of lumen_case_open(), without FILE. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_open_bytes(const void* bytes, size_t size, lumen_case** out,
                                                        lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Copies a case.
 * On LUMEN_CASE_OK *out is a case of its own, to be closed; otherwise it is null.
 * Fails with MEMORY or ARGUMENT. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_copy(const lumen_case* from, lumen_case** out) LUMEN_CASE_NOEXCEPT;

/* Frees a case, or does nothing with null. Cannot fail. O(1). */
LUMEN_CASE_CALL void lumen_case_close(lumen_case* value) LUMEN_CASE_NOEXCEPT;

/* The nodes of the tree, as arrays of `count` entries, and the links. */
typedef struct lumen_case_nodes {
  size_t count;                /* at most 2^24 */
  const float (*centre)[3];    /* mm */
  const float (*direction)[3]; /* unit vector along the vessel, away from the parent */
  const float* radius;         /* mm, > 0 */
  const float* height;         /* mm, >= 0: length of the node's cylinder along its direction */
  const int32_t* parent;       /* a node of a lower index, or -1 for a root */
  const uint32_t* branch;      /* index of the node's branch */
  const float* inlier_rate;    /* 0 to 1; null if unknown */
  size_t link_count;           /* pairs of nodes that are joined besides parents and children */
  const uint32_t (*link)[2];   /* the smaller first, in ascending order */
} lumen_case_nodes;

/* The nodes of a case, without a copy. Cannot fail. O(1). */
LUMEN_CASE_CALL lumen_case_nodes lumen_case_get_nodes(const lumen_case* value) LUMEN_CASE_NOEXCEPT;

/* Values are those of the file format. */
typedef enum lumen_case_kind { LUMEN_CASE_VESSEL = 0, LUMEN_CASE_ANEURYSM = 1 } lumen_case_kind;

/* Reason why tracking of a branch ended. Values are only appended. */
typedef enum lumen_case_stop {
  LUMEN_CASE_STOP_UNKNOWN = 0,           /* not recorded, or not tracked from a volume */
  LUMEN_CASE_STOP_NO_VALID_CYLINDER = 1, /* no cylinder fitted the wall */
  LUMEN_CASE_STOP_TURNED_BACK = 2,       /* the next centre lay on the path already tracked */
  LUMEN_CASE_STOP_LEFT_VOLUME = 3,
  LUMEN_CASE_STOP_MET_BRANCH = 4,        /* the next centre lay in another branch */
  LUMEN_CASE_STOP_END_OF_SEEDS = 5,
  LUMEN_CASE_STOP_STEP_LIMIT = 6
} lumen_case_stop;

/* A range of nodes, each the child of the one before. */
typedef struct lumen_case_branch {
  const char* label;       /* unique in its case; null for an index that is no branch */
  lumen_case_kind kind;
  int32_t parent_node;     /* parent of the first node; -1 for a root */
  uint32_t first_node, node_count;
  lumen_case_stop stop;
  float mean_inlier_rate;  /* 0 to 1; NaN if unknown */
} lumen_case_branch;

/* The number of branches. Cannot fail. O(1). */
LUMEN_CASE_CALL size_t lumen_case_branch_count(const lumen_case* value) LUMEN_CASE_NOEXCEPT;

/* The branch of an index, which is below lumen_case_branch_count(). Cannot fail. O(1). */
LUMEN_CASE_CALL lumen_case_branch lumen_case_get_branch(const lumen_case* value, size_t index) LUMEN_CASE_NOEXCEPT;

/* Index of the branch with a label; SIZE_MAX if there is none. Cannot fail. O(branches). */
LUMEN_CASE_CALL size_t lumen_case_find_branch(const lumen_case* value, const char* label) LUMEN_CASE_NOEXCEPT;

/* Points on the wall: node i owns position[offset[i]] .. position[offset[i + 1] - 1]. */
typedef struct lumen_case_points {
  size_t count;               /* of positions */
  const uint32_t* offset;     /* one per node and one more; null: the case has no wall points */
  const float (*position)[3]; /* mm */
} lumen_case_points;

/* The wall points of a case, without a copy. Cannot fail. O(1). */
LUMEN_CASE_CALL lumen_case_points lumen_case_get_points(const lumen_case* value) LUMEN_CASE_NOEXCEPT;

/* Implicit models, which libblob (blob.h) evaluates: node i owns the blobs offset[i] .. offset[i + 1] - 1, and its
 * function is f(X) = sum w_j phi(|X - C_j|^2 / w_j^2), inside where f > iso_level. */
typedef struct lumen_case_models {
  int32_t kernel;           /* a blob_kernel of blob.h: 0 Cauchy, 1 Gaussian, 2 quartic, 3 soft object */
  double kernel_parameter;  /* ignored by the compact kernels 2 and 3 */
  double iso_level;         /* mm */
  size_t count;             /* of blobs */
  const uint32_t* offset;   /* one per node and one more; null: the case has no models */
  const float (*centre)[3]; /* mm */
  const float* width;       /* mm, > 0 */
} lumen_case_models;

/* The models of a case, without a copy. Cannot fail. O(1). */
LUMEN_CASE_CALL lumen_case_models lumen_case_get_models(const lumen_case* value) LUMEN_CASE_NOEXCEPT;

/* Poses of some nodes over time (spec/lumen.md, "Motion"): tree, wall points and models are those at rest. The pose of
 * node[n] at time[t] is pose[t * node_count + n]: centre x, y, z in mm; rotation x, y, z, w, a unit quaternion; and the
 * factor of the radius. It carries a point X that is at rest to centre + factor * R (X - the centre at rest). */
typedef struct lumen_case_motion {
  size_t time_count;      /* 1 to 4096; 0: the case has no motion */
  const double* time;     /* s, ascending; null without a motion */
  double period;          /* s; 0: not periodic */
  size_t node_count;      /* moving nodes; all others rest */
  const uint32_t* node;   /* ascending */
  const float (*pose)[8]; /* time_count * node_count */
} lumen_case_motion;

/* The motion of a case, without a copy. Cannot fail. O(1). */
LUMEN_CASE_CALL lumen_case_motion lumen_case_get_motion(const lumen_case* value) LUMEN_CASE_NOEXCEPT;

/* Poses of all nodes at any time (s), between the times as spec/lumen.md defines it; at rest without a motion.
 * The caller provides room for `count` poses, which is the number of nodes; each is as those of lumen_case_motion.
 * Fails with ARGUMENT, for a time that is not finite too, or MEMORY. O(nodes). */
LUMEN_CASE_CALL lumen_case_status lumen_case_poses_at(const lumen_case* value, double time, size_t count,
                                                      double (*pose)[8]) LUMEN_CASE_NOEXCEPT;

/* Geometry of the volume that a case was made from. */
typedef struct lumen_case_source {
  uint32_t size[3];    /* voxels along i, j, k */
  double spacing[3];   /* mm along i, j, k */
  double origin[3];    /* centre of voxel (0,0,0), mm */
  double direction[9]; /* row-major; column a is the direction of index axis a */
  const char* sha256;  /* lower-case hexadecimal digest of the voxels; null without a source */
} lumen_case_source;

/* The source volume of a case, without a copy. Cannot fail. O(1). */
LUMEN_CASE_CALL lumen_case_source lumen_case_get_source(const lumen_case* value) LUMEN_CASE_NOEXCEPT;

/* Size of the source's voxels, mm: the geometric mean of their spacing; NaN if unknown. Cannot fail. O(1). */
LUMEN_CASE_CALL double lumen_case_voxel_size(const lumen_case* value) LUMEN_CASE_NOEXCEPT;

/* The note for people, or an empty text. Cannot fail. O(1). */
LUMEN_CASE_CALL const char* lumen_case_note(const lumen_case* value) LUMEN_CASE_NOEXCEPT;

/* A processing step that made the case what it is; the oldest has index 0. */
typedef struct lumen_case_step {
  const char* name; /* "track", "fit", ...; null for an index that is no step */
  const char* tool; /* program and version */
} lumen_case_step;

/* The number of steps. Cannot fail. O(1). */
LUMEN_CASE_CALL size_t lumen_case_step_count(const lumen_case* value) LUMEN_CASE_NOEXCEPT;

/* The step of an index. Cannot fail. O(1). */
LUMEN_CASE_CALL lumen_case_step lumen_case_get_step(const lumen_case* value, size_t index) LUMEN_CASE_NOEXCEPT;

typedef enum lumen_case_type { LUMEN_CASE_F32 = 0, LUMEN_CASE_I32 = 1, LUMEN_CASE_U32 = 2 } lumen_case_type;

/* Further values of each node. */
typedef struct lumen_case_array {
  const char* name;     /* EXTENSION.name; null for an index that is no array */
  const char* unit;     /* for people; may be empty */
  uint32_t components;  /* numbers of a node, 1 to 16 */
  lumen_case_type type;
  const void* values;   /* nodes * components numbers of this type, those of a node together */
} lumen_case_array;

/* The number of node arrays. Cannot fail. O(1). */
LUMEN_CASE_CALL size_t lumen_case_array_count(const lumen_case* value) LUMEN_CASE_NOEXCEPT;

/* The node array of an index, without a copy. Cannot fail. O(1). */
LUMEN_CASE_CALL lumen_case_array lumen_case_get_array(const lumen_case* value, size_t index) LUMEN_CASE_NOEXCEPT;

/* ---------------------------------------------------------------- validating */

/* The number of faults of each severity. */
typedef struct lumen_case_counts { size_t errors, warnings, information; } lumen_case_counts;

/* Receives one fault, which lives during the call; `user` is the caller's. Must not throw. */
typedef void (*lumen_case_receive)(const lumen_case_fault* fault, void* user);

/* Checks the bytes of a file of either encoding against every rule of the format.
 * The caller provides the bytes, the number of faults to receive at most, a receiver or null, what is handed to it,
 * and room for the counts or null.
 * Returns LUMEN_CASE_OK if there is no error, and RULE if there is one. Errors are received first; *counts counts all
 * faults, received or not.
 * Fails with MEMORY or ARGUMENT, too. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_validate_bytes(const void* bytes, size_t size, size_t at_most,
                                                            lumen_case_receive receive, void* user,
                                                            lumen_case_counts* counts) LUMEN_CASE_NOEXCEPT;

/* Checks a file as lumen_case_validate_bytes() checks its bytes.
 * Fails with FILE, too, whose reason is received as a fault. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_validate_file(const char* path, size_t at_most, lumen_case_receive receive,
                                                           void* user, lumen_case_counts* counts) LUMEN_CASE_NOEXCEPT;

/* ---------------------------------------------------------------- writing */

typedef enum lumen_case_encoding {
  LUMEN_CASE_BY_NAME = 0, /* JSON for a path that ends in ".json", otherwise binary; binary without a path */
  LUMEN_CASE_BINARY = 1,
  LUMEN_CASE_JSON = 2
} lumen_case_encoding;

/* Options for writing. */
typedef struct lumen_case_write_def {
  lumen_case_encoding encoding;
  int32_t compress;   /* 1: zstd for every chunk that it makes smaller; libblob reads no compressed models */
  int32_t point_bits; /* 1 to 30: bits of wall points within their bounding box; 0: exact */
  uint32_t cookie;    /* set by lumen_case_write_def_default() */
} lumen_case_write_def;

/* Default options: by name, not compressed, exact. Cannot fail. O(1). */
LUMEN_CASE_CALL lumen_case_write_def lumen_case_write_def_default(void) LUMEN_CASE_NOEXCEPT;

/* Writes a case to a file: the whole new file is there afterwards, or the old one.
 * The caller provides a path (UTF-8), and options or null for the default.
 * Equal cases give equal bytes; compressed ones and rounded ones as far as zstd and Draco do.
 * Fails with MEMORY, ARGUMENT, WRITE, or RULE for a case without nodes. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_save(const lumen_case* value, const char* path,
                                                  const lumen_case_write_def* def,
                                                  lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Writes a case to memory.
 * On LUMEN_CASE_OK *bytes are *size bytes, to be freed by lumen_case_free(); otherwise null and 0.
 * Options and failures are those of lumen_case_save(), without WRITE. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_encode(const lumen_case* value, const lumen_case_write_def* def,
                                                    void** bytes, size_t* size,
                                                    lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Frees bytes of lumen_case_encode(), or does nothing with null. Cannot fail. O(1). */
LUMEN_CASE_CALL void lumen_case_free(void* bytes) LUMEN_CASE_NOEXCEPT;

/* clang-format on */

#ifdef __cplusplus
}
#endif

#endif
