// SPDX-License-Identifier: Apache-2.0
// The rim of bone in computed tomography (docs/method.md, section 1.13).
#pragma once

#include <Eigen/Core>

#include "converters/voxels/cell_box.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Tells the rim of bone, through which the level of blood passes on its way to that of bone, from
/// the middle of a vessel beside bone: the former is an edge, and the latter lies between two. The
/// volume must outlive it. Any number of threads may use one.
class BoneRim {
public:
  /// `soft`, `brightest`: levels of soft tissue and of the brightest blood, voxel units.
  BoneRim(const Volume& volume, float soft, float brightest)
      : m_volume(volume), m_cells(volume.geometry.cells()), m_soft(soft), m_brightest(brightest) {}

  /// Whether the level changes at a voxel hardly less steeply than around it.
  [[nodiscard]] bool isOn(const Cell& cell) const;
  /// Whether a place, mm, LPS, lies in bone, or beside it where the level changes as steeply as an
  /// edge of blood does at least.
  [[nodiscard]] bool isOn(const Eigen::Vector3d& place) const;

private:
  [[nodiscard]] float value(const Cell& cell) const;
  /// Change of the level between the neighbours of a voxel, per voxel, squared.
  [[nodiscard]] float slope(const Cell& cell) const;
  /// Calls visit(cell) for the voxels around one that blur may reach.
  template <class Visit>
  void forEachAround(const Cell& cell, const Visit& visit) const;

  const Volume& m_volume;
  CellBox m_cells;
  float m_soft, m_brightest;
};

}  // namespace lumen::convert
