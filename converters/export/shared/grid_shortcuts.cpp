// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/grid_shortcuts.h"

#include <cmath>

namespace lumen::convert {

GridShortcuts::GridShortcuts(const GridSource& source, const Lattice& lattice, Progress& progress)
    : m_source(source) {
  if (std::isfinite(source.band))
    m_source.near = &m_near.emplace(source, lattice);
  else
    m_source.far = &m_far.emplace(source, lattice, progress);
}

}  // namespace lumen::convert
