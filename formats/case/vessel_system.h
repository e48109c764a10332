// SPDX-License-Identifier: Apache-2.0
// Systems of vessels: the node array LUMEN_vessel.system (spec/lumen.md, extensions).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "formats/case/case.h"

namespace lumen::formats {

/// The blood that runs in a vessel. Values are stored in files: append only.
enum class VesselSystem : std::uint8_t {
  Unknown = 0,
  Artery = 1,
  Vein = 2,
  TrueLumen = 3,   ///< of a dissection
  FalseLumen = 4,  ///< of a dissection
};
constexpr std::size_t kVesselSystemCount = 5;
inline constexpr std::array<std::string_view, kVesselSystemCount> kVesselSystemNames = {
    "unknown", "artery", "vein", "true-lumen", "false-lumen"};

constexpr const char* kSystemExtension = "LUMEN_vessel";
constexpr const char* kSystemArray = "LUMEN_vessel.system";

/// True for systems that are never joined: an artery and a vein, say. The true lumen is that of its
/// arteries; of an unknown system nothing is known.
constexpr bool areApart(VesselSystem a, VesselSystem b) {
  if (a == VesselSystem::TrueLumen) a = VesselSystem::Artery;
  if (b == VesselSystem::TrueLumen) b = VesselSystem::Artery;
  return a != b && a != VesselSystem::Unknown && b != VesselSystem::Unknown;
}

/// One value for each node of a valid case; all are unknown if the case has no such array.
std::vector<VesselSystem> readNodeSystems(const Case& value);

/// One value for each branch of a valid case: the one that most of its nodes have.
std::vector<VesselSystem> readBranchSystems(const Case& value);

/// The same; empty if all are unknown.
std::vector<VesselSystem> knownBranchSystems(const Case& value);

/// Replaces the node array of a case by `systems`, one value for each node, and lists its extension;
/// removes both if all are unknown.
void setNodeSystems(Case& value, const std::vector<VesselSystem>& systems);

}  // namespace lumen::formats
