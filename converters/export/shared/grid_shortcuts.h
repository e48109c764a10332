// SPDX-License-Identifier: Apache-2.0
// Shortcuts to the samples of a lattice that are far from all walls.
#pragma once

#include <optional>

#include "converters/export/shared/far_field.h"
#include "converters/export/shared/near_cells.h"

namespace lumen::convert {

/// A source with a shortcut: with a band, the cells beyond it are not asked; without one, distances
/// far from all walls come from coarse cells.
class GridShortcuts {
public:
  /// Throws Error(Cancelled).
  GridShortcuts(const GridSource& source, const Lattice& lattice, Progress& progress);
  GridShortcuts(const GridShortcuts&) = delete;
  GridShortcuts& operator=(const GridShortcuts&) = delete;

  [[nodiscard]] const GridSource& source() const { return m_source; }

private:
  GridSource m_source;
  std::optional<FarField> m_far;
  std::optional<NearCells> m_near;
};

}  // namespace lumen::convert
