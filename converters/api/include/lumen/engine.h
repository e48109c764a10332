/* SPDX-License-Identifier: Apache-2.0
 *
 * The engine of lumen for programs in C99, C++11 and whatever calls C: a volume, a label map, a
 * mesh or a centerline in memory becomes a case of vessels, and a case a surface. No function
 * opens, writes or looks for a file.
 *
 * A NIfTI in memory becomes a GLB in memory:
 *
 *     lumen_engine_fault fault;
 *     lumen_engine_source* head = NULL;
 *     lumen_engine_case* vessels = NULL;
 *     lumen_engine_bytes* mesh = NULL;
 *     lumen_engine_inputs inputs = {0};
 *     inputs.main.name = "head.nii.gz";  // its ending names the format
 *     inputs.main.bytes = bytes;
 *     inputs.main.size = size;
 *     if (lumen_engine_load(&inputs, NULL, NULL, &head, &fault) ||
 *         lumen_engine_case_of(head, NULL, NULL, &vessels, &fault) ||
 *         lumen_engine_encode(vessels, "glb", NULL, NULL, &mesh, &fault))
 *       puts(fault.message);
 *     // lumen_engine_bytes_data(mesh), lumen_engine_bytes_size(mesh)
 *     lumen_engine_free_bytes(mesh);
 *     lumen_engine_free_case(vessels);
 *     lumen_engine_free_source(head);
 *
 * and an array becomes arrays, if these lines take the place of others:
 *
 *     lumen_engine_volume array = {"head", voxels, LUMEN_ENGINE_INT16, {512, 512, 300},
 *                                  {{0.4, 0, 0, -102}, {0, 0.4, 0, -102}, {0, 0, 0.6, -90}}};
 *     inputs.volume = &array;  // instead of inputs.main
 *     lumen_engine_surface_of(vessels, NULL, NULL, &surface, &fault);
 *     lumen_engine_mesh m = lumen_engine_get_mesh(surface);  // m.position, m.triangle, ...
 *
 * Build: cc program.c $(pkg-config --cflags --libs lumen-engine); with CMake, link lumen::engine
 * of find_package(lumen COMPONENTS engine).
 *
 * Units and frame. Lengths are millimetres, positions are LPS patient coordinates: +x left,
 * +y posterior, +z superior. Arrays of positions have the shape [count][3].
 *
 * Failure. Functions that can fail return a status, which is 0 on success, and describe the reason
 * in *fault unless that is null; what they were to hand out is null then. On success the message
 * is empty. No function prints, exits or throws. lumen_engine_free_...() take null.
 *
 * Cases. Bytes of the format "lumen" are what lumen_case_open_bytes() of lumen/case.h takes, which
 * gives the tree with its nodes, parents and radii, and blob_model_open_bytes() of blob.h, which
 * answers questions about places.
 *
 * Threads. A call works on all cores, or on as many as the listener says; its results do not depend
 * on their number. Different handles do not affect each other. A case may be read by any number of
 * calls at once. Worker threads sleep on after a call: fork() before the first one, or else exec at
 * once, and never dlclose() the library.
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
#define LUMEN_ENGINE_API
#else
#define LUMEN_ENGINE_API __attribute__((visibility("default")))
#endif
#ifdef __cplusplus
#define LUMEN_ENGINE_NOEXCEPT noexcept
extern "C" {
#else
#define LUMEN_ENGINE_NOEXCEPT
#endif

/* Number of the interface. It grows when functions are added. */
#define LUMEN_ENGINE_INTERFACE 1

/* That number of the library that runs, and its version, such as "0.2.0". Cannot fail. O(1). */
LUMEN_ENGINE_API int lumen_engine_interface(void) LUMEN_ENGINE_NOEXCEPT;
LUMEN_ENGINE_API const char* lumen_engine_version(void) LUMEN_ENGINE_NOEXCEPT;

/* ---------------------------------------------------------------- status */

/* Result of a call; the first five are the exit codes of the program. Values are only appended. */
typedef enum lumen_engine_status {
  LUMEN_ENGINE_OK = 0,
  LUMEN_ENGINE_FAILED = 1,      /* such as: no vessel is found */
  LUMEN_ENGINE_USAGE = 2,       /* a null pointer, an unknown option, options that exclude others */
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
 * into lumen. They are called from all threads that work, but one at a time. */
typedef struct lumen_engine_listener {
  void* user; /* handed to each function */
  /* A stage begins. lumen_engine_load(): reading. lumen_engine_case_of(): find, track or
   * wall points, fit, among others. A surface: cells, lattice, topology, extracting, remeshing,
   * crossings, among others. Names are for people, and later versions may have others. */
  void (*stage)(void* user, const char* name);
  /* The share of this stage that is done, from 0 to 1. Stages take unlike times, and those whose
   * end is not known are silent. */
  void (*progress)(void* user, double done);
  /* A warning, one line. */
  void (*warning)(void* user, const char* sentence);
  /* Asked at least ten times a second: not 0 ends the call with CANCELLED, most often within a
   * tenth of a second. For a handler of signals, let it return a volatile sig_atomic_t. */
  int (*is_cancelled)(void* user);
  int32_t threads; /* that work at most; 0: all cores */
} lumen_engine_listener;

/* ---------------------------------------------------------------- products */

/* Bytes that belong to the caller. */
typedef struct lumen_engine_bytes lumen_engine_bytes;

/* Null and 0 for null. Cannot fail. O(1). */
LUMEN_ENGINE_API const void* lumen_engine_bytes_data(
    const lumen_engine_bytes* bytes) LUMEN_ENGINE_NOEXCEPT;
LUMEN_ENGINE_API size_t lumen_engine_bytes_size(
    const lumen_engine_bytes* bytes) LUMEN_ENGINE_NOEXCEPT;
LUMEN_ENGINE_API void lumen_engine_free_bytes(lumen_engine_bytes* bytes) LUMEN_ENGINE_NOEXCEPT;

/* ---------------------------------------------------------------- options */

/* Options of `lumen convert`, by the names of its help, without hyphens. Null in place of options
 * means that none is given. Give the same options to each call: each takes those that concern it.
 * lumen_engine_load() takes those of the inputs ("mask"), lumen_engine_case_of() those of vessels
 * and models ("root", "accuracy"); both refuse one that does nothing for this source. A product
 * takes those of surfaces and files ("edge", "colour"), and passes over those of other formats. */
typedef struct lumen_engine_options lumen_engine_options;

/* Fails with MEMORY. */
LUMEN_ENGINE_API lumen_engine_status lumen_engine_create_options(
    lumen_engine_options** out, lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;
LUMEN_ENGINE_API void lumen_engine_free_options(
    lumen_engine_options* options) LUMEN_ENGINE_NOEXCEPT;

/* Sets an option: "accuracy" to "0.2"; a flag to "true" or "false". Vessels are taken to be bright
 * unless "dark" is "true". One that may be given several times is added to: "root" to "12,-30,4".
 * Fails with USAGE for a name that is unknown, for a value that is not allowed, and for an option
 * that names a file, whose bytes lumen_engine_inputs takes. O(1). */
LUMEN_ENGINE_API lumen_engine_status lumen_engine_set_option(
    lumen_engine_options* options, const char* name, const char* value,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

/* All options as a JSON array of objects of texts: name, group, value ("MM", "WORD"; empty for a
 * flag), default, help. Fails with USAGE or MEMORY. */
LUMEN_ENGINE_API lumen_engine_status lumen_engine_list_options(
    lumen_engine_bytes** out, lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

/* ---------------------------------------------------------------- sources */

/* Bytes under the name of a file. The ending of the name states the format; messages name it. */
typedef struct lumen_engine_file {
  const char* name;
  const void* bytes; /* read during the call only */
  size_t size;
} lumen_engine_file;

/* Types of voxels. */
typedef enum lumen_engine_type {
  LUMEN_ENGINE_INT16 = 0,
  LUMEN_ENGINE_UINT8 = 1,
  LUMEN_ENGINE_UINT16 = 2,
  LUMEN_ENGINE_FLOAT32 = 3
} lumen_engine_type;

/* A volume in memory. Voxel (i, j, k) lies at data[i + size[0] * (j + size[1] * k)], and its
 * centre at affine * (i, j, k, 1), mm, LPS. (NIfTI's affine is RAS: negate its first two rows.) */
typedef struct lumen_engine_volume {
  const char* name; /* for messages */
  const void* data; /* copied during the call */
  lumen_engine_type type;
  int32_t size[3];     /* each at least 2 */
  double affine[3][4]; /* columns 0 to 2 are orthogonal, right- or left-handed */
} lumen_engine_volume;

/* One patient's input: `main` or `volume`, and what may stand beside it. Parts that are absent are
 * all zero. */
typedef struct lumen_engine_inputs {
  const lumen_engine_volume* volume;
  lumen_engine_file main;        /* volume: .nii, .nii.gz, .nrrd, .mha;
                                    surface of vessels: .stl, .ply, .obj, .glb, .gltf, .vtp, .vtk;
                                    centerline: .swc, .tre, .centerline.vtp, .mrk.json;
                                    case, which gets models if it has none: .lumen, .lumen.json */
  lumen_engine_file seeds;       /* of grey voxels: clicks, lumen's .json, 3D Slicer's .mrk.json
                                    or .fcsv */
  lumen_engine_file corrected;   /* of grey voxels: a case whose corrections are made again */
  lumen_engine_file label_map;   /* of a volume: one of labels that name its vessels */
  lumen_engine_file label_table; /* of labels: their names; the content decides how it is read */
  lumen_engine_file centerline;  /* of a surface: .swc, .tre, .vtp or .mrk.json */
} lumen_engine_inputs;

/* What a case is made of. */
typedef struct lumen_engine_source lumen_engine_source;

/* Reads and checks the inputs. A volume is a label map if "mask", "label", "labels" or a label
 * table without a label map says so, or if its voxels show it and there are no seeds for it.
 * Fails with USAGE, INPUT (bytes, a size, an affine or voxels that are no volume), UNSUPPORTED,
 * CANCELLED or MEMORY. Linear in the bytes, unpacked; one copy of an array. */
LUMEN_ENGINE_API lumen_engine_status lumen_engine_load(
    const lumen_engine_inputs* inputs, const lumen_engine_options* options,
    const lumen_engine_listener* listener, lumen_engine_source** out,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

LUMEN_ENGINE_API void lumen_engine_free_source(lumen_engine_source* source) LUMEN_ENGINE_NOEXCEPT;

/* ---------------------------------------------------------------- cases */

/* A case: the tree of vessels, points on their walls, and models. */
typedef struct lumen_engine_case lumen_engine_case;

/* Finds, tracks, names and fits the vessels of a source, as `lumen convert` does. The source is
 * used up: its voxels are gone, also after a failure, and another call with it fails with USAGE.
 * It is still to be freed.
 * Fails with USAGE, INPUT, FAILED, CANCELLED or MEMORY. Seconds to minutes, on all cores. */
LUMEN_ENGINE_API lumen_engine_status lumen_engine_case_of(
    lumen_engine_source* source, const lumen_engine_options* options,
    const lumen_engine_listener* listener, lumen_engine_case** out,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

/* The case in the bytes of a file of either encoding, .lumen or .lumen.json, as it is.
 * Fails with USAGE, INPUT or MEMORY. Linear in the bytes. */
LUMEN_ENGINE_API lumen_engine_status lumen_engine_open_case(
    const lumen_engine_file* file, lumen_engine_case** out,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

LUMEN_ENGINE_API void lumen_engine_free_case(lumen_engine_case* value) LUMEN_ENGINE_NOEXCEPT;

/* Number of branches; 0 for null. Cannot fail. O(1). */
LUMEN_ENGINE_API size_t lumen_engine_branch_count(
    const lumen_engine_case* value) LUMEN_ENGINE_NOEXCEPT;
/* Name of a branch, which stays until the case is freed; null for one that does not exist. O(1). */
LUMEN_ENGINE_API const char* lumen_engine_branch_name(
    const lumen_engine_case* value, size_t branch) LUMEN_ENGINE_NOEXCEPT;
/* The branch that a branch leaves; SIZE_MAX for a root, and for one that does not exist. O(1). */
LUMEN_ENGINE_API size_t lumen_engine_branch_parent(
    const lumen_engine_case* value, size_t branch) LUMEN_ENGINE_NOEXCEPT;

/* A case as the bytes of a file: "lumen", "lumen.json"; its surface as "glb", "gltf", "vtp", "obj",
 * "stl", "ply"; its tree as "swc", "tre", "centerline.vtp", "mrk.json",
 * "graphml", "am", "vmv".
 * Fails with UNSUPPORTED for another format, with INPUT for a surface of a case without models,
 * with USAGE, CANCELLED or MEMORY. Seconds for a surface. */
LUMEN_ENGINE_API lumen_engine_status lumen_engine_encode(
    const lumen_engine_case* value, const char* format, const lumen_engine_options* options,
    const lumen_engine_listener* listener, lumen_engine_bytes** out,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

/* ---------------------------------------------------------------- surfaces */

/* The surface of a case as arrays. */
typedef struct lumen_engine_surface lumen_engine_surface;

typedef struct lumen_engine_mesh {
  size_t vertex_count;
  const float (*position)[3]; /* mm, LPS */
  const float (*normal)[3];   /* unit, out of the lumen */
  const float* radius;        /* of the nearest place on the centerline, mm */
  const uint32_t* branch;     /* number of the branch there: lumen_engine_branch_name() */
  size_t triangle_count;
  const uint32_t (*triangle)[3]; /* vertices, counter-clockwise seen from outside */
  const uint32_t* group;         /* of each triangle: lumen_engine_group_name() */
  size_t group_count;
} lumen_engine_mesh;

/* Makes the surface of a case with models: closed, one 2-manifold for each connected tree.
 * A vessel ends in a plane beyond its last node, by half of that node's height and at least half
 * of its radius, or less where the wall closes before: so the surface goes on by up to a radius or
 * so where the border of the image cuts the vessel, and also where it ends within the image.
 * Triangles in the plane close it, a group of their own, and vertices at their rim have the wall's
 * normals. An end that no plane can cut stays round, "cap-..." (docs/method.md, Ends).
 * Failures are those of lumen_engine_encode(). */
LUMEN_ENGINE_API lumen_engine_status lumen_engine_surface_of(
    const lumen_engine_case* value, const lumen_engine_options* options,
    const lumen_engine_listener* listener, lumen_engine_surface** out,
    lumen_engine_fault* fault) LUMEN_ENGINE_NOEXCEPT;

/* The arrays of a surface, which stay until it is freed. All zero for null. O(1). */
LUMEN_ENGINE_API lumen_engine_mesh lumen_engine_get_mesh(
    const lumen_engine_surface* surface) LUMEN_ENGINE_NOEXCEPT;
/* Name of a group, such as "wall" or "outlet-ica"; null for one that does not exist. O(1). */
LUMEN_ENGINE_API const char* lumen_engine_group_name(
    const lumen_engine_surface* surface, size_t group) LUMEN_ENGINE_NOEXCEPT;
LUMEN_ENGINE_API void lumen_engine_free_surface(
    lumen_engine_surface* surface) LUMEN_ENGINE_NOEXCEPT;

#ifdef __cplusplus
}
#endif
/* clang-format on */
#endif
