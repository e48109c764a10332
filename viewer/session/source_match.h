// SPDX-License-Identifier: Apache-2.0
// Whether a document's volumes and case are of one patient, as far as files can show it.
#pragma once

#include <optional>
#include <string>

#include "converters/voxels/volume.h"
#include "viewer/session/document/document.h"

namespace lumen::viewer {

/// The name of the file of that role, for people.
std::string shownName(const Document& document, FileRole role);

/// A sentence on the volume from which the case was not made. None if the case is of this volume or
/// states no volume, and if it records that a person has accepted this one.
std::optional<std::string> otherSource(const Document& document);

/// Throws Error(Usage) with otherSource() and the ways out, if there is one: what is tracked in one
/// volume does not come into a case of another by mistake.
void requireOneSource(const Document& document);

/// The document whose case records, as a step with the digest of the voxels, that its volume was
/// accepted. Throws Error(Usage) if there is nothing to accept.
Document withAcceptedVolume(const Document& document);

/// Share of the second volume that lies in the first, or of the first in the second: the greater,
/// in [0, 1]. Both are sampled at places that are spread evenly over them.
double sharedPart(const convert::VolumeGeometry& first, const convert::VolumeGeometry& second);

/// A sentence on what speaks against both volumes being seen at one place: they do not overlap or
/// hardly do, they have the same voxels at other places, or the open case was made from the second
/// and not from the first. None without a second volume and where nothing does. Files do
/// not state the patient, so an empty answer does not prove that both are of one.
std::optional<std::string> secondDoubt(const Document& document);

}  // namespace lumen::viewer
