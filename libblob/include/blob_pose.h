/* SPDX-License-Identifier: Apache-2.0
 *
 * Models of libblob that move (C99, C++11).
 *
 * A pose moves the nodes of a model at rest. Each node has a transform: its rest surroundings X are
 * carried to
 *
 *     X' = centre + factor * R (X - O)
 *
 * where O is the node's centre at rest and R a rotation. The node's blobs ride on it: the posed
 * model of a node is f'(X') = f(X), its radius is factor times the radius at rest, and posed nodes
 * blend as those of any model do, with the powers and weights of their posed centres and radii. So
 * between two nodes the transforms are interpolated by the weights of the blended field, f stays as
 * smooth as at rest, and vessels that touch stay apart: neighbours are those of the tree. See
 * spec/lumen.md, "Motion".
 *
 * A posed model is a blob_model: every query of blob.h answers on it, at the same cost and with the
 * same instructions. In short:
 *
 *     blob_pose* pose;
 *     if (blob_pose_create(vessel, NULL, &pose) != BLOB_OK) return 1;
 *     for (;;) {                                                     // a step of a simulator
 *       blob_pose_set_centres(pose, count, nodes, centres, NULL);    // or blob_pose_set()
 *       blob_query(blob_pose_model(pose), 0, point, &cursor, &s);
 *     }
 *     blob_pose_close(pose);
 *
 * Units, frame, signs, failures and misuse are those of blob.h. A pose has one writer at a time,
 * and no reader while it is set; otherwise any number of threads may query its model.
 */
#ifndef LUMEN_BLOB_POSE_H
#define LUMEN_BLOB_POSE_H

#include "blob.h"

/* Comments stand in columns. */
/* clang-format off */

#ifdef __cplusplus
extern "C" {
#endif

/* A node's transform. */
typedef struct blob_transform {
  double centre[3];   /* where the node's centre is, mm; within 1e6 of zero; kept as floats */
  double rotation[4]; /* R as a quaternion x, y, z, w; of any length that is not zero */
  double factor;      /* of the radius; 1e-3 to 1e3; 1: the surroundings move as a rigid body */
} blob_transform;

/* A model and the transforms of its nodes. */
typedef struct blob_pose blob_pose;

/* Options of a pose. */
typedef struct blob_pose_def {
  /* Strain beyond which the tables of neighbours are made anew, see blob_pose_strain(); default
   * 0.25. */
  double strain_limit;
  /* 1 (default): a change that exceeds the limit makes the tables anew, which allocates. 0: it
   * reports itself as stale, and blob_pose_renew() does the work when the caller has the time. */
  int renew;
  uint32_t cookie; /* set by blob_pose_def_default() */
} blob_pose_def;

/* Default options.
 * Returns a definition; change its fields, not its cookie. Cannot fail. O(1). */
BLOB_API blob_pose_def blob_pose_def_default(void) BLOB_NOEXCEPT;

/* Makes a pose in which nothing has moved: its model answers with the bits of `rest`.
 * The caller provides a model that no pose owns, which must stay open as long as the pose, and a
 * definition or null for the default.
 * On BLOB_OK *pose is a pose, to be closed by blob_pose_close(); otherwise it is null.
 * Fails with BLOB_ERROR_MEMORY, or _ARGUMENT (null, a posed model, another definition, a limit that
 * is not more than 0). O(n); it takes about the memory of the model, and 0.2 kB for each node. */
BLOB_API blob_status blob_pose_create(const blob_model* rest, const blob_pose_def* def,
                                      blob_pose** pose) BLOB_NOEXCEPT;

/* Frees a pose and its model.
 * The caller provides a pose whose model no query uses any more, or null, which does nothing. */
BLOB_API void blob_pose_close(blob_pose* pose) BLOB_NOEXCEPT;

/* The posed model, for all queries of blob.h and blob_device_pack(); not to be closed.
 * Returns the same pointer all the time: a change of the pose changes the model. The box of
 * blob_model_describe() holds the balls of all nodes, and may be larger. O(1). */
BLOB_API const blob_model* blob_pose_model(const blob_pose* pose) BLOB_NOEXCEPT;

/* Report on a change of a pose. */
typedef struct blob_pose_change {
  double strain; /* the greatest of the edges at the nodes that were set, see blob_pose_strain() */
  int renewed;   /* 1: the tables of neighbours were made anew */
  int stale;     /* 1: the strain exceeds the limit, and the tables are those of before */
} blob_pose_change;

/* Sets the transforms of nodes.
 * The caller provides `count` indices, or null for the nodes 0 to count - 1; a transform for each;
 * and room for a report, or null. The last transform of an index that occurs twice counts.
 * Fails with BLOB_ERROR_TOPOLOGY (an index that is no node), _RANGE (a number that is not finite or
 * out of its range) or, with def.renew alone, _MEMORY; the pose is then as it was, but for _MEMORY,
 * after which it is posed and stale.
 * O(changed nodes and their neighbours) and no allocation, unless tables are made anew; the
 * hierarchy of blob_cursor_locate() follows in O(changed nodes * log n). Half a kilobyte of memory
 * is written for each node. */
BLOB_API blob_status blob_pose_set(blob_pose* pose, size_t count, const uint32_t* nodes,
                                   const blob_transform* transforms,
                                   blob_pose_change* change) BLOB_NOEXCEPT;

/* Sets nodes for which a simulator knows centres alone, as masses on springs do: each of these
 * nodes, and each at the other end of an edge of one, gets the least rotation that turns the
 * direction of the vessel at rest into that of the posed centres; factors stay. A turn of more than
 * half a circle against the rest is not seen.
 * The caller provides indices as for blob_pose_set(), a centre for each, mm, and room for a report,
 * or null.
 * Fails and costs as blob_pose_set(). */
BLOB_API blob_status blob_pose_set_centres(blob_pose* pose, size_t count, const uint32_t* nodes,
                                           const double (*centres)[3],
                                           blob_pose_change* change) BLOB_NOEXCEPT;

/* Looks up a node's transform.
 * The caller provides an index.
 * Returns it, its quaternion of length 1; NaN for an index that is no node. O(1). */
BLOB_API blob_transform blob_pose_node(const blob_pose* pose, uint32_t node) BLOB_NOEXCEPT;

/* The strain of the whole pose against the one for which its tables of neighbours were made: the
 * greatest over all edges i, k, from both ends, of
 *     |R_i^-1 (O'_k - O'_i) / s_i - (O_k - O_i)| / d  +  max(r_i, r_k) * angle(R_i, R_k) / d
 * with O, r and d at rest, s the factor, and R and O' as they changed since then: the stretch of
 * the axis, and what bending adds at the wall. Cursors and blending rest on these tables: nodes
 * that come near each other along the tree by bending become neighbours only when the tables are
 * made anew. The angle is right to 1 % up to half a radian. O(n). */
BLOB_API double blob_pose_strain(const blob_pose* pose) BLOB_NOEXCEPT;

/* Makes the tables of neighbours anew from the posed centres and radii, as for a model at rest.
 * The value of the field changes where nodes become neighbours, or are none any more; cursors stay
 * valid.
 * Fails with BLOB_ERROR_MEMORY, and leaves the pose as it was. O(n log n). */
BLOB_API blob_status blob_pose_renew(blob_pose* pose) BLOB_NOEXCEPT;

/* A transform between two: centre and factor are interpolated linearly, the rotation along the
 * shorter arc (slerp), as spec/lumen.md has it between two times.
 * The caller provides two transforms and a fraction, which is held within 0 to 1.
 * Returns a transform with a quaternion of length 1. O(1). */
BLOB_API blob_transform blob_transform_between(const blob_transform* from, const blob_transform* to,
                                               double fraction) BLOB_NOEXCEPT;

/* Sets a pose between two others of the same model at rest, node by node.
 * The caller provides three poses; `pose` may be one of the others.
 * Fails with BLOB_ERROR_ARGUMENT (another model), else as blob_pose_set(). O(n). */
BLOB_API blob_status blob_pose_blend(blob_pose* pose, const blob_pose* from, const blob_pose* to,
                                     double fraction, blob_pose_change* change) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- motions */

/* Poses of nodes over time, as a .lumen file holds them. */
typedef struct blob_motion blob_motion;

/* Reads the motion of a .lumen file.
 * The caller provides its path (UTF-8), and a definition of blob_open_def_default() or null; its
 * `simd` means nothing here.
 * On BLOB_OK *motion is a motion, to be closed by blob_motion_close(); otherwise it is null.
 * Fails with BLOB_ERROR_NO_MOTION, or as blob_model_open(). O(file size). */
BLOB_API blob_status blob_motion_open(const char* path, const blob_open_def* def,
                                      blob_motion** motion) BLOB_NOEXCEPT;

/* Reads the motion of a .lumen file that is in memory: `size` bytes of any alignment, which are read
 * during the call only. Result, failures and cost are those of blob_motion_open(). */
BLOB_API blob_status blob_motion_open_bytes(const void* bytes, size_t size,
                                            const blob_open_def* def,
                                            blob_motion** motion) BLOB_NOEXCEPT;

/* Frees a motion, or does nothing for null. */
BLOB_API void blob_motion_close(blob_motion* motion) BLOB_NOEXCEPT;

/* Properties of a motion. */
typedef struct blob_motion_info {
  size_t time_count, node_count; /* nodes that move */
  double first, last;            /* s */
  double period;                 /* s; 0: not periodic */
} blob_motion_info;

/* Describes a motion. Returns its counts and times. Cannot fail. O(1). */
BLOB_API blob_motion_info blob_motion_describe(const blob_motion* motion) BLOB_NOEXCEPT;

/* Sets the nodes that a motion moves to where they are at a time; all others stay as they are.
 * The caller provides a motion of the case that the model at rest is of, any finite number of
 * seconds (a periodic motion repeats, another one stays at its ends), and room for a report, or null.
 * Fails with BLOB_ERROR_ARGUMENT (a case with another number of nodes), _RANGE (a time that is not
 * finite), or as blob_pose_set(), as which it costs, and a few dozen nanoseconds for each node. */
BLOB_API blob_status blob_pose_set_time(blob_pose* pose, const blob_motion* motion, double seconds,
                                        blob_pose_change* change) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- forces and velocities */

/* Lists the nodes that answer at a point, and their weights in the blended field, whose sum is 1.
 * With them a simulator spreads a force F at the point X over the nodes of the vessel: node k gets
 * w_k F at its centre O', and the torque w_k (X - O') x F.
 * The caller provides any model, flags (BLOB_LOCAL: the cursor's node alone), a point and its
 * cursor, as for blob_query(), and room for `capacity` nodes and weights; 24 are always enough.
 * Returns the number of nodes, and writes the first `capacity`, in the order in which they were
 * found; 0 for a point that is not finite or farther than 1e9 mm.
 * O(nodes that blend); scalar code in doubles. */
BLOB_API size_t blob_query_weights(const blob_model* model, uint32_t flags, const double point[3],
                                   uint32_t* cursor, uint32_t* nodes, double* weights,
                                   size_t capacity) BLOB_NOEXCEPT;

/* The velocity with which the surroundings of a point move between two poses of one model: the
 * weighted mean of the velocities of the nodes that answer, each as a body of its own,
 *     v = sum w_k (X - T_k(S_k^-1(X))) / seconds
 * with S_k a node's transform in `pose` and T_k that in `before`. At the wall, v . normal is the
 * speed at which the wall advances, to first order in the time between the poses.
 * The caller provides both poses, the seconds between them (not zero), flags, and a point with its
 * cursor in `pose`.
 * velocity[3], mm/s, is the answer; NaN for a point that is not finite. Cannot fail.
 * O(nodes that blend). */
BLOB_API void blob_pose_velocity(const blob_pose* pose, const blob_pose* before, double seconds,
                                 uint32_t flags, const double point[3], uint32_t* cursor,
                                 double velocity[3]) BLOB_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#endif
