// SPDX-License-Identifier: Apache-2.0
// Label maps beside a volume: they name branches, and choose among them.
#pragma once

#include <string>
#include <vector>

#include "converters/operations/context.h"
#include "converters/operations/source.h"
#include "converters/stages/tracking/track_case.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// The labels of a map that name branches: those that no table and no person states to be no
/// vessels, or regions.
struct NamingMap {
  std::string name;  ///< for messages, printable
  convert::LabelMask mask;
  std::vector<convert::LabelRole> roles;  ///< of each label of the mask
};

/// One for each map beside the volume of this geometry, which messages call `named`. Throws
/// Error(InvalidInput) for voxels that are no labels, or lie elsewhere.
std::vector<NamingMap> namingMaps(const std::vector<LabelPart>& maps,
                                  const convert::VolumeGeometry& geometry,
                                  const std::string& named);

/// The label of a branch: that of the first map that has one for it.
struct BranchLabel {
  std::size_t map = 0;
  convert::NamedStretch stretch;  ///< its label is 0 if no map has one
};

/// One for each branch.
std::vector<BranchLabel> labelsOfBranches(const std::vector<NamingMap>& maps,
                                          const formats::CenterlineTree& tree);

/// Names the branches of a case by the labels on which they lie, whose roles state their systems. Where several maps have a label,
/// that of the first counts. Warns of a map on which no branch lies.
void nameByMaps(const std::vector<NamingMap>& maps, formats::Case& target, const Context& context);

/// Leaves out the branches without a label on which none with a label hangs; an aneurysm stays with
/// its vessel. Throws Error(Failed) if none has a label.
void leaveOutUnlabelled(const std::vector<NamingMap>& maps, formats::Case& target,
                        const std::string& named);

/// Gives the remarks on ends the names that their branches have now, and drops those of branches
/// that are gone.
void renameEnds(const formats::CenterlineTree& tree, std::vector<convert::TrackEnd>& ends);

/// Records a volume beside that of a case as a step, `NAME` with the digest `NAME-sha256`.
void recordVolume(const std::string& name, const convert::Volume& volume, formats::Case& target);

/// Records the maps of a case as its steps.
void recordMaps(const std::vector<LabelPart>& maps, formats::Case& target);

/// Gives the labels of a mask names, where they are known.
void useNames(const convert::LabelNames& names, convert::LabelMask& mask);

/// The role of each label of a mask.
std::vector<convert::LabelRole> rolesOf(const convert::LabelMask& mask,
                                        const std::vector<convert::LabelMeaning>& meanings);

}  // namespace lumen::operations
