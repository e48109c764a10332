// SPDX-License-Identifier: Apache-2.0
// Clutter of a phantom: synthetic structures and losses that disturb finding, and belong to no truth.
//
// | name | shows |
// |---|---|
// | bone | a curved slab, cortex brighter than vessels around a spongy inside, beside a vessel's wall |
// | vein | a dimmer, wider tube that runs along a vessel and winds half around it |
// | streaks | a metal ball beside a vessel, with bright and dark streaks in its slices, as in CT |
// | stent | bright wires in the wall of a stretch of a vessel |
// | void | a stretch of a vessel that has lost its signal, as flow loses it in time-of-flight MR |
//
// Sizes are shares of the radius of the vessel beside them and of the volume's edge. The vessel is
// drawn from the phantom's seed, each kind by itself, so that a kind is equal alone and with others.
// Vessels keep their intensity where bone, vein or metal overlap them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/phantom/design.h"
#include "converters/stages/phantom/render.h"

namespace lumen::convert {

enum class Clutter : std::uint8_t { Bone, Vein, Streaks, Stent, Void };

/// Names of the kinds, in the order of the table above.
const std::vector<std::string>& clutterNames();

/// The words of a list with commas between them, as indices of `names`; none of an empty list.
/// Throws Error(Usage), which names `field` and expects `kind`, such as "kinds of clutter", if a word
/// is none of `names` or occurs twice.
std::set<std::size_t> chosenWords(const std::string& list, const std::vector<std::string>& names,
                                  const std::string& field, const std::string& kind);

/// The kinds that a list such as "bone,vein" names; none for an empty text. Throws Error(Usage) for
/// an unknown name and for one that occurs twice.
std::set<Clutter> parseClutter(const std::string& list, const FieldWord& fieldWord = {});

/// Lowers the contrast of a stretch of five radii, to a twentieth in its middle, if `kinds` hold Void.
void loseFlow(const std::set<Clutter>& kinds, std::uint64_t seed, Design& design);

/// The slices that addClutter() reports to its progress.
std::size_t clutterSteps(const std::set<Clutter>& kinds, const Design& design,
                         const VolumeGeometry& grid);

/// Adds all kinds but Void to the occupancy of `design` in `image`, as shares of the full contrast.
/// Needs up to three more images of its size. Throws Error(Cancelled).
void addClutter(const std::set<Clutter>& kinds, const Design& design, const VolumeGeometry& grid,
                std::uint64_t seed, Image& image, Progress& progress);

}  // namespace lumen::convert
