// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/label_prior.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <variant>

#include <Eigen/Core>
#include <tbb/parallel_for.h>

#include "converters/base/vectors.h"
#include "formats/case/vessel_system.h"

namespace lumen::operations {
namespace {

using convert::LabelRole;
using convert::Prior;

constexpr std::uint8_t kArterial = 1, kVenous = 2, kFalseLumen = 3, kRegion = 254;

/// A guess from a name takes no vessel away.
std::uint8_t statementOf(const convert::LabelMeaning& meaning) {
  switch (meaning.role) {
    case LabelRole::Vessel:
    case LabelRole::Artery:
    case LabelRole::Aneurysm:
    case LabelRole::TrueLumen:
      return kArterial;
    case LabelRole::Vein:
      return kVenous;
    case LabelRole::FalseLumen:
      return kFalseLumen;
    case LabelRole::Unknown:
      return Prior::kNothing;
    case LabelRole::Region:
      return meaning.isStated ? kRegion : Prior::kNothing;
    default:
      return meaning.isStated ? Prior::kNoVessel : Prior::kNothing;
  }
}

/// Calls visit(voxel, statement) for each voxel of a volume about which a map says something.
template <class Visit>
void forEachStatement(const LabelPart& map, const convert::VolumeGeometry& geometry,
                      const Progress& progress, const Visit& visit) {
  std::unordered_map<std::int64_t, std::uint8_t> statements;
  for (const convert::LabelMeaning& meaning : map.meanings)
    if (const std::uint8_t said = statementOf(meaning); said != Prior::kNothing)
      statements[meaning.value] = said;
  if (statements.empty()) return;
  const convert::VolumeGeometry& own = map.voxels.geometry;
  const convert::CellBox cells = geometry.cells();
  const Eigen::Vector3d first = own.indexFromWorld(geometry.worldFromIndex({0, 0, 0}));
  Eigen::Matrix3d step;
  for (int a = 0; a < 3; ++a)
    step.col(a) = own.indexFromWorld(geometry.worldFromIndex(Eigen::Vector3d::Unit(a))) - first;
  std::visit(
      [&](const auto& voxels) {
        tbb::parallel_for(0, cells.size[2], [&](int z) {
          progress.check();
          convert::CellBox slice = cells;
          slice.low[2] = z;
          slice.size[2] = 1;
          slice.forEach([&](const convert::Cell& cell) {
            const auto at = own.cells().nearest(first + step * cell.cast<double>());
            if (!at) return;
            const auto found = statements.find(static_cast<std::int64_t>(voxels[own.index(*at)]));
            if (found != statements.end()) visit(cells.index(cell), found->second);
          });
        });
      },
      map.voxels.voxels);
}

formats::VesselSystem systemAt(const convert::FoundVessels& found, const Eigen::Vector3d& point) {
  const convert::CellBox cells = found.geometry.cells();
  const auto cell = cells.nearest(found.geometry.indexFromWorld(point));
  if (!cell) return formats::VesselSystem::Unknown;
  const auto at = std::lower_bound(found.lumen.begin(), found.lumen.end(), cells.index(*cell));
  if (at == found.lumen.end() || *at != cells.index(*cell)) return formats::VesselSystem::Unknown;
  const std::uint8_t system = found.systems[static_cast<std::size_t>(at - found.lumen.begin())];
  return system == kArterial     ? formats::VesselSystem::Artery
         : system == kVenous     ? formats::VesselSystem::Vein
         : system == kFalseLumen ? formats::VesselSystem::FalseLumen
                                 : formats::VesselSystem::Unknown;
}

}  // namespace

void setSystemsOf(const convert::FoundVessels& found, formats::Case& value) {
  if (found.systems.empty()) return;
  const formats::CenterlineTree& tree = value.tree;
  std::vector<formats::VesselSystem> systems;
  for (const formats::Branch& branch : tree.branches) {
    std::array<std::size_t, formats::kVesselSystemCount> count{};
    for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
      ++count[static_cast<std::size_t>(systemAt(found, toEigen(tree.centre[n])))];
    count[0] = 0;
    const auto most = std::max_element(count.begin(), count.end());
    systems.insert(systems.end(), branch.nodeCount,
                   static_cast<formats::VesselSystem>(most - count.begin()));
  }
  formats::setNodeSystems(value, systems);
}

convert::Prior priorOf(const std::vector<LabelPart>& maps, const convert::VolumeGeometry& geometry,
                       const Progress& progress) {
  std::vector<std::uint8_t> said(geometry.voxelCount(), Prior::kNothing),
      isInRegion(geometry.voxelCount(), 0);
  for (const LabelPart& map : maps)
    forEachStatement(map, geometry, progress, [&](std::size_t i, std::uint8_t statement) {
      if (statement == kRegion)
        isInRegion[i] = 1;
      else if (said[i] == Prior::kNothing || said[i] == Prior::kNoVessel)
        said[i] = statement;
    });
  const bool hasRegion = std::find(isInRegion.begin(), isInRegion.end(), 1) != isInRegion.end();
  bool saysAnything = hasRegion;
  for (std::size_t i = 0; i < said.size(); ++i) {
    if (hasRegion && isInRegion[i] == 0) said[i] = Prior::kNoVessel;
    saysAnything = saysAnything || said[i] != Prior::kNothing;
  }
  if (!saysAnything) said.clear();
  return {std::move(said)};
}

}  // namespace lumen::operations
