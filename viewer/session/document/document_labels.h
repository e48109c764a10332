// SPDX-License-Identifier: Apache-2.0
// The label map of a document: the roles of its labels, as pages show and change them.
#pragma once

#include <memory>
#include <vector>

#include "converters/operations/source.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/document.h"

namespace lumen::viewer {

/// The one of `maps`, which holds labels of the volume of a document. Throws Error(InvalidInput) for
/// voxels that are no labels, or lie elsewhere.
std::shared_ptr<const OpenLabels> openLabels(std::vector<operations::LabelPart> maps,
                                             const Document& document);

/// The map of a document as tracking takes it, with the roles that its labels have now; none without
/// one.
std::vector<operations::LabelPart> mapsOf(const Document& document);

/// The map with the place of each label in the list, counted from 1, in place of its value.
convert::Volume placesOf(const OpenLabels& labels);

/// The document in which the "label" of a request has another "role", and a title for undo. Throws
/// Error(Usage) for a label or a role that is none.
struct ChangedRole {
  Document document;
  std::string title;
};
ChangedRole withRole(const Document& document, const Arguments& request);

/// The map as the state has it (viewer/README.md).
Json labelsJson(const Document& document);

}  // namespace lumen::viewer
