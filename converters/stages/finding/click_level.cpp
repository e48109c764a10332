// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/click_level.h"

#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

#include "converters/base/statistics.h"
#include "converters/voxels/cell_box.h"

namespace lumen::convert {

ClickLevels::ClickLevels(const Volume& volume, bool areVesselsDark, const Progress& progress)
    : m_volume(volume),
      m_sign(areVesselsDark ? -1 : 1),
      m_background(volume, static_cast<float>(m_sign), progress) {
  constexpr double kQuietShare = 0.25;  // as of the blocks around a place
  constexpr auto kStep = static_cast<std::size_t>(Background::kBlock);
  std::vector<float> row, levels;
  const Cell last = volume.geometry.cells().high();
  for (int z = 0; z <= last.z(); z += Background::kBlock)
    for (int y = 0; y <= last.y(); y += Background::kBlock) {
      m_background.alongRow(y, z, row);
      for (std::size_t x = 0; x < row.size(); x += kStep)
        if (!std::isnan(row[x])) levels.push_back(row[x]);
    }
  if (!levels.empty()) m_quiet = m_sign * double{lowerQuantile(levels, kQuietShare)};
}

ClickLevel ClickLevels::at(const Eigen::Vector3d& place) const {
  const VolumeGeometry& geometry = m_volume.geometry;
  const Eigen::Vector3d last = geometry.cells().high().cast<double>();
  const Eigen::Vector3d index =
      geometry.indexFromWorld(place).cwiseMax(Eigen::Vector3d::Zero()).cwiseMin(last);
  const Cell cell = index.array().round().cast<int>();
  double sum = 0;
  std::size_t count = 0;
  std::visit(
      [&](const auto& voxels) {
        const CellBox around{cell - Cell::Ones(), Cell::Constant(3)};
        around.meet(geometry.cells()).forEach([&](const Cell& one) {
          const std::size_t i = geometry.index(one);
          if (!geometry.isImage(i)) return;
          sum += static_cast<double>(voxels[i]);
          ++count;
        });
      },
      m_volume.voxels);
  std::vector<float> row(static_cast<std::size_t>(geometry.cells().size[0]));
  m_background.alongRow(cell.y(), cell.z(), row);
  ClickLevel level;
  level.background = m_sign * double{row[static_cast<std::size_t>(cell.x())]};
  // outside of the image there is nothing but background
  level.value = count == 0 ? level.background : sum / static_cast<double>(count);
  level.quiet = m_quiet;
  level.noise = double{m_background.noise()};
  return level;
}

}  // namespace lumen::convert
