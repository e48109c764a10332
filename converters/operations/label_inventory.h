// SPDX-License-Identifier: Apache-2.0
// The vessels of a case by the labels of the maps beside its volume.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "converters/operations/context.h"
#include "converters/operations/label_maps.h"
#include "converters/operations/source.h"
#include "converters/stages/finding/prior.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// An end of a branch that lies beyond the label after which it is named.
struct BeyondLabel {
  std::string branch;
  bool isStart = false;  ///< else its tip
  double length = 0;     ///< from the last node with a label on, mm
};

/// Voxels of a label of vessels that lie in no vessel of the case, by what the volume shows there.
enum class LeftOut {
  NotVessel,  ///< a map states that there is none
  Faint,      ///< less contrast than the vessels have
  Strong,     ///< more than these, as bone and metal
  NoWall,     ///< the contrast of these, but no wall was found around it
};
constexpr std::size_t kLeftOutCount = 4;

struct MappedLabel {
  convert::LabelMeaning meaning;
  std::size_t voxels = 0;
  std::vector<std::string> branches;  ///< those that are named after it
  double length = 0;                  ///< of these, mm
  double stated = 0;  ///< of that, where the volume shows no wall, so that it is the map's, mm
  double leastRadius = 0, meanRadius = 0, greatestRadius = 0;  ///< of their nodes, mm
  std::vector<BeyondLabel> beyond;
  /// Share of its voxels in the volume that lie in the lumen of the case, or within half a voxel of
  /// the map from it; negative if none lies in the volume, and for labels that name no branch.
  double heldShare = -1;
  std::string missing;  ///< reason why no branch is named after a label of vessels; else empty
  std::optional<std::array<double, kLeftOutCount>> leftOut;  ///< mm^3; of vessels in an image
  double refused = 0;  ///< volume of no vessel that is at least as bright as vessels, mm^3
};

struct MappedLabels {
  std::string name;  ///< of the map
  std::vector<MappedLabel> labels;
};

struct LabelInventory {
  std::vector<MappedLabels> maps;
  std::vector<std::string> unlabelled;  ///< branches without a label
  double unlabelledLength = 0;          ///< mm
};

/// The image beside maps, and what they state about it.
struct ImageBesideMaps {
  const convert::Volume& volume;
  const convert::Prior& prior;
  bool dark = false;
};

/// `naming` are those of `maps`. `image` is null for a volume of labels. Time: seconds for millions
/// of labelled voxels, on all threads. Throws Error(Cancelled).
LabelInventory inventoryOf(const std::vector<LabelPart>& maps, const std::vector<NamingMap>& naming,
                           const formats::Case& value, const convert::VolumeGeometry& geometry,
                           const ImageBesideMaps* image, const Context& context);

}  // namespace lumen::operations
