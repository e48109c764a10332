// SPDX-License-Identifier: Apache-2.0
// Where the aortic arch lies in a network: the course of the aorta, and what rises from its arch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "converters/stages/anatomy/vessel_network.h"

namespace lumen::convert {

/// A vessel that leaves the course of the aorta upwards.
struct GreatVessel {
  std::size_t place = 0;    ///< in the course
  std::uint32_t first = 0;  ///< its first node
  double radius = 0;        ///< mm, outside of the aorta
  double left = 0;          ///< x of where it rises past the arch, mm
};

struct ArchLandmarks {
  std::vector<std::uint32_t> course;  ///< of the aorta, along the flow
  std::size_t apex = 0;               ///< its highest place
  std::size_t foot = 0, end = 0;      ///< where the arch's limbs are compared, before and behind it
  double radius = 0;                  ///< of the arch, mm, the unit of its proportions
  std::vector<GreatVessel> vessels;   ///< along the flow
  double plausible = 0;               ///< 0: there is no arch
};

/// The most plausible arch of all trees.
ArchLandmarks findArch(const VesselNetwork& network, std::size_t nodeCount);

}  // namespace lumen::convert
