// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/bone_rim.h"

#include <algorithm>
#include <variant>

#include "converters/voxels/trilinear.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kBlur = 2;  // voxels that an edge may be wide to either side
/// Share of the steepest change beside it above which a change is an edge. The blurred edge of a
/// bone that is up to ten times as bright as blood is steeper where its level is that of blood:
/// a Gaussian of .44 of its height, at a tenth of its sum.
constexpr float kEdge = 0.35F;
/// The same in units of blood's contrast, per voxel: an edge of blood itself, as blurred as a voxel
/// is wide, has .4 of it.
constexpr double kEdgeOfBlood = 0.3;
/// Contrast of bone in units of blood's at least.
constexpr float kBone = 1.5F;

}  // namespace

float BoneRim::value(const Cell& cell) const {
  const std::size_t i = m_cells.index(cell);
  return std::visit([i](const auto& voxels) { return static_cast<float>(voxels[i]); },
                    m_volume.voxels);
}

float BoneRim::slope(const Cell& cell) const {
  const double voxel = m_volume.geometry.voxelSize();
  float sum = 0;
  for (int a = 0; a < 3; ++a) {
    const Cell step = Cell::Unit(a), up = (cell + step).cwiseMin(m_cells.high()),
               down = (cell - step).cwiseMax(m_cells.low);
    if (up == down) continue;
    const double length = (up[a] - down[a]) * m_volume.geometry.spacing[a];
    const float change = (value(up) - value(down)) * static_cast<float>(voxel / length);
    sum += change * change;
  }
  return sum;
}

template <class Visit>
void BoneRim::forEachAround(const Cell& cell, const Visit& visit) const {
  const Cell reach = Cell::Constant(kBlur);
  CellBox::between(cell - reach, cell + reach).meet(m_cells).forEach(visit);
}

bool BoneRim::isOn(const Cell& cell) const {
  float steepest = 0;
  forEachAround(cell, [&](const Cell& other) { steepest = std::max(steepest, slope(other)); });
  return slope(cell) >= kEdge * kEdge * steepest;
}

bool BoneRim::isOn(const Vector3d& place) const {
  const Vector3d at = m_volume.geometry.indexFromWorld(place);
  const auto sample = [&](const Vector3d& position) {
    return trilinear(m_cells, position, [&](const Cell& cell) { return value(cell); });
  };
  const float contrast = m_brightest - m_soft, bone = m_soft + kBone * contrast;
  if (sample(at) > static_cast<double>(bone)) return true;
  bool isBeside = false;
  forEachAround(at.array().round().cast<int>().matrix(),
                [&](const Cell& cell) { isBeside = isBeside || value(cell) > bone; });
  if (!isBeside) return false;
  Vector3d change;
  for (int a = 0; a < 3; ++a)
    change[a] = (sample(at + Vector3d::Unit(a)) - sample(at - Vector3d::Unit(a))) /
                (2 * m_volume.geometry.spacing[a]);
  return change.norm() * m_volume.geometry.voxelSize() >
         kEdgeOfBlood * static_cast<double>(contrast);
}

}  // namespace lumen::convert
