// SPDX-License-Identifier: Apache-2.0
// The role of a label: what the voxels are that have it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/case/vessel_system.h"

namespace lumen::convert {

enum class LabelRole : std::uint8_t {
  Unknown,
  // vessels, each with its name
  Vessel,  ///< of no system that is known
  Artery,
  Vein,
  // lumens that are no plain vessel, each a lumen of its own
  Chamber,    ///< of the heart
  Aneurysm,   ///< its sac
  TrueLumen,  ///< of a dissection
  FalseLumen,
  // not a lumen
  Bone,
  Metal,
  Calcium,
  Organ,  ///< or other tissue, fluid outside of vessels, air
  Region  ///< the place where vessels are looked for
};

/// "unknown", "vessel", "artery", "vein", "chamber", "aneurysm", "true-lumen", "false-lumen",
/// "bone", "metal", "calcium", "organ", "region", in the order of the roles.
const std::vector<std::string>& roleWords();
const std::string& roleWord(LabelRole role);
/// The role of such a word, or nothing.
std::optional<LabelRole> roleOfWord(std::string_view word);

constexpr bool isVessel(LabelRole role) {
  return role >= LabelRole::Vessel && role <= LabelRole::Vein;
}
constexpr bool isOtherLumen(LabelRole role) {
  return role >= LabelRole::Chamber && role <= LabelRole::FalseLumen;
}
constexpr bool isNotVessel(LabelRole role) {
  return role >= LabelRole::Bone && role <= LabelRole::Organ;
}

/// The system of the vessels of a role; unknown for those that may be of either, and for an aneurysm,
/// which is of the vessel that it hangs on.
constexpr formats::VesselSystem systemOf(LabelRole role) {
  switch (role) {
    case LabelRole::Artery:
      return formats::VesselSystem::Artery;
    case LabelRole::Vein:
      return formats::VesselSystem::Vein;
    case LabelRole::TrueLumen:
      return formats::VesselSystem::TrueLumen;
    case LabelRole::FalseLumen:
      return formats::VesselSystem::FalseLumen;
    default:
      return formats::VesselSystem::Unknown;
  }
}

/// The words of a name in small letters with _ between them, by which names are compared:
/// "Left Renal-Artery" and "leftRenalArtery" are "left_renal_artery".
std::string plainName(std::string_view name);

/// The role that the words of a name show, by the rules of roles.txt; Unknown if they show none.
LabelRole roleOfName(std::string_view name);

}  // namespace lumen::convert
