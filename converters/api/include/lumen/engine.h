/* SPDX-License-Identifier: Apache-2.0
 *
 * The engine of lumen for programs in C99, C++11 and whatever calls C: a volume, a label map, a mesh
 * or a centerline in memory becomes a case, and a case a surface. No function opens, writes or looks
 * for a file, but lumen_engine_options_set() says which options name none.
 *
 * In short, a NIfTI in memory to a GLB in memory:
 *
 *     lumen_engine_fault fault;
 *     lumen_engine_source* head = NULL;
 *     lumen_engine_case* vessels = NULL;
 *     lumen_engine_bytes* mesh = NULL;
 *     lumen_engine_inputs inputs = {0};
 *     inputs.main.name = "head.nii.gz";          // its ending names the format
 *     inputs.main.bytes = bytes;
 *     inputs.main.size = size;
 *     if (lumen_engine_load(&inputs, NULL, NULL, &head, &fault) ||
 *         lumen_engine_case_of(head, NULL, NULL, &vessels, &fault) ||
 *         lumen_engine_encode(vessels, "glb", NULL, NULL, &mesh, &fault))
 *       puts(fault.message);
 *     // lumen_engine_data(mesh), lumen_engine_size(mesh)
 *     lumen_engine_free_bytes(mesh);
 *     lumen_engine_free_case(vessels);
 *     lumen_engine_free_source(head);
 *
 * How to read this header. Each function's comment states the work, the caller's arguments, the
 * result, failures and the cost.
 *
 * Units and frame. Lengths are millimetres, positions are LPS patient coordinates: +x left,
 * +y posterior, +z superior. Arrays of positions have the shape [count][3].
 *
 * Failure. Functions that can fail return a status, which is 0 on success, and describe the reason
 * in *fault unless that is null. What they were to hand out is null then. No function prints, exits
 * or throws. Functions of the form lumen_engine_free_...() take null.
 *
 * Cases. lumen_engine_encode() with the format "lumen" gives the bytes that lumen_case_open_bytes()
 * of lumen/case.h and blob_model_open_bytes() of blob.h take.
 *
 * Threads. A call works on all cores, or on as many as the listener says; its results do not depend
 * on their number. Different handles do not affect each other. A case may be read by any number of
 * calls at once. Listeners are called from all threads that work, one call at a time.
 *
 * Compatibility. Programs that were linked with liblumen-engine.so.1 run with every later one of
 * that number: functions, and values of enumerations, are only added; structs do not change.
 */
#ifndef LUMEN_ENGINE_H
#define LUMEN_ENGINE_H

/* Comments stand in columns. */
/* clang-format off */

#include <stddef.h>
#include <stdint.h>

#if defined(LUMEN_ENGINE_STATIC) || defined(_WIN32)
#define LUMEN_ENGINE_CALL
#else
#define LUMEN_ENGINE_CALL __attribute__((visibility("default")))
#endif
#ifdef __cplusplus
#define LUMEN_ENGINE_NOEXCEPT noexcept
extern "C" {
#else
#define LUMEN_ENGINE_NOEXCEPT
#endif

/* Number of the interface. It grows when functions are added. */
#define LUMEN_ENGINE_INTERFACE 1

/* Version of the library that runs, such as "0.2.0". Static. Cannot fail. O(1). */
LUMEN_ENGINE_CALL const char* lumen_engine_version(void) LUMEN_ENGINE_NOEXCEPT;

/* ---------------------------------------------------------------- status */

/* Result of a call; the first five are the exit codes of the program. Values are only appended. */
typedef enum lumen_engine_status {
  LUMEN_ENGINE_OK = 0,
  LUMEN_ENGINE_FAILED = 1,      /* such as: no vessel is found */
  LUMEN_ENGINE_USAGE = 2,       /* a null pointer, an unknown option, options that exclude one another */
  LUMEN_ENGINE_INPUT = 3,       /* the bytes are damaged, or not what they have to be */
  LUMEN_ENGINE_UNSUPPORTED = 4, /* legal, but not read or written by lumen */
  LUMEN_ENGINE_MEMORY = 5,      /* the system has no more memory */
  LUMEN_ENGINE_CANCELLED = 130  /* the listener asked for the end */
} lumen_engine_status;

/* Reason of a failure: one line for people, in English, cut off at a whole character. */
typedef struct lumen_engine_fault {
  char message[1024];
} lumen_engine_fault;

/* ---------------------------------------------------------------- listener */

/* What a long call reports, and how it may be ended. A null function hears nothing. None may call
 * into lumen. */
typedef struct lumen_engine_listener {
  void* user; /* handed to each function */
  /* A stage begins: its name, such as "track". */
  void (*stage)(void* user, const char* name);
  /* Done so far in this stage, from 0 to 1; not called where the end is not known. */
  void (*progress)(void* user, double done);
  /* A warning, one line. */
  void (*warning)(void* user, const char* sentence);
  /* Asked at least ten times a second: not 0 ends the call with CANCELLED. */
  int (*is_cancelled)(void* user);
  int32_t threads; /* that work at most; 0: all cores */
} lumen_engine_listener;

/* ---------------------------------------------------------------- options */

/* Options of `lumen convert`, by the names of its help, without hyphens. Null in place of options
 * means that none is given. */
typedef struct lumen_engine_options lumen_engine_options;

/* Fails with MEMORY. */
LUMEN_ENGINE_CALL lumen_engine_status lumen_engine_options_create(
    lumen_engine_options** out, lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;
LUMEN_ENGINE_CALL void lumen_engine_options_free(lumen_engine_options* options) LUMEN_ENGINE_NOEXCEPT;

/* Sets an option: "accuracy" to "0.2", "root" to "12,-30,4"; a flag to "true" or "false".
 * Fails with USAGE for a name that is unknown, for a value that is not allowed, and for an option
 * that names a file (seeds, label-map, centerline, corrections, a label-table that is not built in):
 * lumen_engine_inputs takes the bytes of these. O(1). */
LUMEN_ENGINE_CALL lumen_engine_status lumen_engine_options_set(
    lumen_engine_options* options, const char* name, const char* value,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

/* ---------------------------------------------------------------- sources */

/* Bytes under the name of a file. The ending of the name states the format; messages name it. */
typedef struct lumen_engine_file {
  const char* name;
  const void* bytes; /* read during the call only */
  size_t size;
} lumen_engine_file;

/* One patient's input. Parts that are absent are all zero. */
typedef struct lumen_engine_inputs {
  lumen_engine_file main;      /* .nii, .nii.gz, .nrrd, .mha; .stl, .ply, .obj, .glb, .vtp, .vtk; .swc, .tre, ... */
  lumen_engine_file seeds;     /* of a volume: clicks, as lumen or 3D Slicer writes them */
  lumen_engine_file label_map; /* of a volume: labels that name its vessels */
} lumen_engine_inputs;

/* Types of voxels. */
typedef enum lumen_engine_type {
  LUMEN_ENGINE_INT16 = 0,
  LUMEN_ENGINE_UINT8 = 1,
  LUMEN_ENGINE_UINT16 = 2,
  LUMEN_ENGINE_FLOAT32 = 3
} lumen_engine_type;

/* A volume in memory. Voxel (i, j, k) lies at data[i + size[0] * (j + size[1] * k)], and its centre at
 * affine * (i, j, k, 1), mm, LPS. (NIfTI's affine is RAS: negate its first two rows.) */
typedef struct lumen_engine_volume {
  const void* data; /* copied during the call */
  lumen_engine_type type;
  int32_t size[3];
  double affine[3][4]; /* columns 0 to 2 are orthogonal */
} lumen_engine_volume;

/* What a case is made of. */
typedef struct lumen_engine_source lumen_engine_source;

/* Reads and checks the inputs. A volume whose voxels are labels is a label map, unless there are
 * seeds for it.
 * Fails with USAGE, INPUT, UNSUPPORTED, CANCELLED or MEMORY. Linear in the bytes, unpacked. */
LUMEN_ENGINE_CALL lumen_engine_status lumen_engine_load(
    const lumen_engine_inputs* inputs, const lumen_engine_options* options,
    const lumen_engine_listener* listener, lumen_engine_source** out,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

/* Takes a volume of intensities, or of labels, that is in memory. `name`: for messages.
 * Fails with USAGE for a null pointer or an unknown type, INPUT for a size, an affine or voxels that
 * are no volume, or MEMORY. One copy of the voxels. */
LUMEN_ENGINE_CALL lumen_engine_status lumen_engine_take_volume(
    const lumen_engine_volume* volume, const char* name, int holds_labels,
    const lumen_engine_options* options, lumen_engine_source** out,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

LUMEN_ENGINE_CALL void lumen_engine_free_source(lumen_engine_source* source) LUMEN_ENGINE_NOEXCEPT;

/* ---------------------------------------------------------------- cases */

/* A case: the tree of vessels, points on their walls, and models. */
typedef struct lumen_engine_case lumen_engine_case;

/* Finds, tracks, names and fits the vessels of a source, as `lumen convert` does. The source is used up: its voxels are gone, also after a failure, and another
 * call with it fails with USAGE. It is still to be freed.
 * Fails with USAGE, INPUT, FAILED, CANCELLED or MEMORY. Seconds to minutes, on all cores. */
LUMEN_ENGINE_CALL lumen_engine_status lumen_engine_case_of(
    lumen_engine_source* source, const lumen_engine_options* options,
    const lumen_engine_listener* listener, lumen_engine_case** out,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

/* The case in the bytes of a file of either encoding, .lumen or .lumen.json.
 * Fails with USAGE, INPUT or MEMORY. Linear in the bytes. */
LUMEN_ENGINE_CALL lumen_engine_status lumen_engine_open_case(
    const lumen_engine_file* file, lumen_engine_case** out,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

LUMEN_ENGINE_CALL void lumen_engine_free_case(lumen_engine_case* value) LUMEN_ENGINE_NOEXCEPT;

/* ---------------------------------------------------------------- products */

/* Bytes that belong to the caller. */
typedef struct lumen_engine_bytes lumen_engine_bytes;
LUMEN_ENGINE_CALL const void* lumen_engine_data(const lumen_engine_bytes* bytes) LUMEN_ENGINE_NOEXCEPT;
LUMEN_ENGINE_CALL size_t lumen_engine_size(const lumen_engine_bytes* bytes) LUMEN_ENGINE_NOEXCEPT;
LUMEN_ENGINE_CALL void lumen_engine_free_bytes(lumen_engine_bytes* bytes) LUMEN_ENGINE_NOEXCEPT;

/* A case as the bytes of a file: "lumen", "lumen.json"; its surface as "glb", "gltf", "vtp", "obj",
 * "stl", "ply"; its tree as "swc", "tre", "centerline.vtp", "mrk.json".
 * Fails with UNSUPPORTED for another format, with INPUT for a surface of a case without models, with
 * USAGE, CANCELLED or MEMORY. Seconds for a surface. */
LUMEN_ENGINE_CALL lumen_engine_status lumen_engine_encode(
    const lumen_engine_case* value, const char* format, const lumen_engine_options* options,
    const lumen_engine_listener* listener, lumen_engine_bytes** out,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

/* The surface of a case as arrays. */
typedef struct lumen_engine_surface lumen_engine_surface;

typedef struct lumen_engine_mesh {
  size_t vertex_count;
  const float (*position)[3]; /* mm, LPS */
  const float (*normal)[3];   /* unit, out of the lumen */
  const float* radius;        /* of the vessel there, mm */
  const uint32_t* branch;     /* number of the vessel there, in the order of the case */
  size_t triangle_count;
  const uint32_t (*triangle)[3]; /* vertices, counter-clockwise seen from outside */
  const uint32_t* group;         /* of each triangle: lumen_engine_group_name() */
  size_t group_count;
} lumen_engine_mesh;

/* Makes the surface of a case with models: closed, one 2-manifold for each connected tree.
 * Failures are those of lumen_engine_encode(). */
LUMEN_ENGINE_CALL lumen_engine_status lumen_engine_surface_of(
    const lumen_engine_case* value, const lumen_engine_options* options,
    const lumen_engine_listener* listener, lumen_engine_surface** out,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

/* The arrays of a surface, which stay until it is freed. All zero for null. O(1). */
LUMEN_ENGINE_CALL lumen_engine_mesh lumen_engine_get_mesh(const lumen_engine_surface* surface) LUMEN_ENGINE_NOEXCEPT;
/* Name of a group, such as "wall" or "outlet-ica"; null for one that does not exist. O(1). */
LUMEN_ENGINE_CALL const char* lumen_engine_group_name(const lumen_engine_surface* surface, size_t group) LUMEN_ENGINE_NOEXCEPT;
LUMEN_ENGINE_CALL void lumen_engine_free_surface(lumen_engine_surface* surface) LUMEN_ENGINE_NOEXCEPT;

#ifdef __cplusplus
}
#endif
/* clang-format on */
#endif
