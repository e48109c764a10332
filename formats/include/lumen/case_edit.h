/* SPDX-License-Identifier: Apache-2.0
 *
 * Cases of lumen, made and changed (C99, C++11). lumen/case.h states units, frame, threads and the
 * life of pointers.
 *
 * Each edit checks the whole case that it would make: O(n). It fails with LUMEN_CASE_ERROR_MEMORY,
 * _ARGUMENT or _RULE, describes the reason in *fault unless that is null, and then the case is as
 * it was. Arrays are copied during the call.
 *
 * An edit removes chunks of other programs that it may have made wrong. It does not track or fit
 * anything: a wall whose points or models no longer fit its nodes needs `lumen fit`.
 */
#ifndef LUMEN_CASE_EDIT_H
#define LUMEN_CASE_EDIT_H

#include "lumen/case.h"

/* Comments stand in columns. */
/* clang-format off */

#ifdef __cplusplus
extern "C" {
#endif

/* Makes a case without nodes, to be filled by lumen_case_set_tree() or lumen_case_append_branch().
 * On LUMEN_CASE_OK *out is a case, to be closed by lumen_case_close(); otherwise it is null.
 * Fails with MEMORY or ARGUMENT. O(1). */
LUMEN_CASE_CALL lumen_case_status lumen_case_create(lumen_case** out) LUMEN_CASE_NOEXCEPT;

/* Replaces the tree. Wall points, models, motion and node arrays, which belong to the former nodes, go.
 * The caller provides nodes with at least count, centre and radius, and `branch_count` branches, of which label, kind,
 * parent_node, node_count and stop count; first_node follows from the counts, and a negative or NaN mean_inlier_rate
 * is unknown. `parent` and `branch` of the nodes follow from the branches and are not read. Null arrays are derived:
 * `direction` from the neighbours along the branch, `height` as twice the mean length of the edges beside the node, or
 * the radius in a branch of one node. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_set_tree(lumen_case* value, const lumen_case_nodes* nodes,
                                                      const lumen_case_branch* branches, size_t branch_count,
                                                      lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Appends a branch of `count` nodes behind all others, with directions and heights derived as by lumen_case_set_tree().
 * The caller provides a label that no branch has, a kind, the node that it leaves or -1, and centres and radii in mm.
 * Wall points and models stay, and the new nodes have none; node arrays hold zeros for them. A motion goes. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_append_branch(lumen_case* value, const char* label, lumen_case_kind kind,
                                                           int32_t parent_node, size_t count, const float (*centre)[3],
                                                           const float* radius,
                                                           lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Removes a branch and all that hang on it, with their wall points, models, poses and values. At least one other branch must
 * stay. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_remove_branch(lumen_case* value, size_t branch,
                                                           lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Sets the label of a branch: unique, not empty, at most 255 bytes of UTF-8 without control characters. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_set_label(lumen_case* value, size_t branch, const char* label,
                                                       lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Sets the kind of a branch. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_set_kind(lumen_case* value, size_t branch, lumen_case_kind kind,
                                                      lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Sets centre and radius of a node, mm. Its wall points, models and direction stay; a motion goes. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_set_node(lumen_case* value, size_t node, const float centre[3],
                                                      float radius, lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Replaces the wall points by `points`, with an offset for each node and one more; null removes them. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_set_points(lumen_case* value, const lumen_case_points* points,
                                                        lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Replaces the models by `models`, with an offset for each node and one more; null removes them. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_set_models(lumen_case* value, const lumen_case_models* models,
                                                        lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Replaces the motion by `motion`, with a pose for each time and moving node; null removes it. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_set_motion(lumen_case* value, const lumen_case_motion* motion,
                                                        lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Adds a node array, or replaces the one of its name, and lists its extension. The caller provides a name
 * EXTENSION.name, a unit or null, and nodes * components values. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_set_array(lumen_case* value, const lumen_case_array* array,
                                                       lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Removes the node array of a name. A name that no array has is an ARGUMENT. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_remove_array(lumen_case* value, const char* name,
                                                          lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Sets the note for people: at most 65535 bytes of UTF-8; empty or null removes it. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_set_note(lumen_case* value, const char* note,
                                                      lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* Records a processing step behind all others: a name, and the program with its version. O(n). */
LUMEN_CASE_CALL lumen_case_status lumen_case_add_step(lumen_case* value, const char* name, const char* tool,
                                                      lumen_case_fault* fault) LUMEN_CASE_NOEXCEPT;

/* clang-format on */

#ifdef __cplusplus
}
#endif

#endif
