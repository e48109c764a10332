// SPDX-License-Identifier: Apache-2.0
// Corrections by hand as requests: by name, with arguments. A case keeps each with the place that
// it was made at, so that it can be made again in another case of the same volume.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/editing/selection.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// A correction (edit.h, wall_edits.h) by the name that the viewer gives it, such as "delete".
struct EditRequest {
  std::string op;
  std::optional<std::uint32_t> branch, node;  ///< by index
  std::string word;  ///< the label, the kind, or a treatment: "go", "child"
  std::optional<Eigen::Vector3d> position, by;  ///< mm, LPS
  std::optional<double> radius, reach;          ///< mm
};

/// The arguments that a correction of that name takes, each as "branch", "node", "word?", ...; a
/// question mark: it may be missing. Null for a name that none has.
const std::vector<std::string>* editArguments(const std::string& op);

/// Makes the correction, and keeps the request beside its sentence in the case's "edit" step.
/// Throws Error(InvalidInput) as the functions of edit.h and wall_edits.h, and for an unknown name
/// or a missing argument.
Change applyEdit(formats::Case& target, const EditRequest& request);

/// A correction that could not be made again.
struct LeftEdit {
  std::string sentence;  ///< as the case had it
  std::string why;
};

struct ReplayedEdits {
  std::vector<std::string> made;  ///< sentences, as the case has them now
  std::vector<LeftEdit> left;
};

/// Makes the corrections that `corrected` keeps again in `target`, in their order. A branch is the
/// one of its label near the place where it was, or else the nearest one there; a node the nearest
/// one. Corrections whose place has no vessel within twice its radius, or that break a rule, are
/// left; so are changes by hand that keep no request, unless `target` has the same sentence. The
/// case's "edit" step keeps those with their requests, so that a later replay tries them again.
ReplayedEdits replayEdits(const formats::Case& corrected, formats::Case& target);

/// Whether the case keeps changes by hand.
bool hasEdits(const formats::Metadata& metadata);

// Requests as texts with places instead of indices. Private to the sources of edit_request.

/// The request as JSON: a branch by its label and its middle node's place, a node by its place and
/// its branch's label, each with the radius there. Branch and node are of `tree`.
std::string textOfRequest(const EditRequest& request, const formats::CenterlineTree& tree);

/// The request that such a text is in another tree. Throws Error(InvalidInput) for a text that is
/// none, and where the tree has no vessel at the place.
EditRequest requestInTree(const std::string& text, const formats::CenterlineTree& tree);

}  // namespace lumen::convert
