// SPDX-License-Identifier: Apache-2.0
// The wall of a case around one of its places, as triangles.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/geometry/box.h"
#include "converters/geometry/marching_cubes.h"
#include "converters/geometry/mesh_measures.h"
#include "formats/case/case.h"
#include "formats/field/blended_field.h"

namespace lumen::convert {

/// The blended field as the nodes near a place see it. Vessels that come near but are not near along
/// the tree are left out. Any number of threads may query it.
class LocalField {
public:
  /// The nodes whose balls, twice as wide, reach into the box and that are joined to the nodes
  /// `from` by such nodes. The case has models; case and field must stay.
  LocalField(const formats::CenterlineTree& tree, const field::BlendedField& field,
             const std::vector<std::uint32_t>& from, const Box3d& box);

  /// Greater than 0 inside, mm.
  [[nodiscard]] double value(const Eigen::Vector3d& point) const;
  [[nodiscard]] const Box3d& box() const { return m_box; }
  [[nodiscard]] const std::vector<std::uint32_t>& nodes() const { return m_nodes; }

private:
  struct Ball {
    Eigen::Vector3d centre;
    double square;
  };
  const field::BlendedField& m_field;
  Box3d m_box;
  std::vector<std::uint32_t> m_nodes;  // ascending
  std::vector<Ball> m_balls;
};

/// A field within a box: greater than 0 inside. Any number of threads may call it.
struct BoxedField {
  Box3d box;
  std::function<double(const Eigen::Vector3d&)> value;
};

/// The wall within a box.
struct LocalSurface {
  TriangleMesh mesh;                 ///< vertices lie on the wall
  std::vector<std::uint8_t> isOpen;  ///< for each vertex, whether the box cuts the wall there
};

/// Samples of a field at the corners of cubes.
class SampledField {
public:
  /// Cubes of edge `cell`, mm. The field must stay. With `coarse`, a field of twice the cell, only cubes near its wall
  /// are sampled.
  SampledField(const BoxedField& field, double cell, const SampledField* coarse,
               const Progress& progress);

  /// The connected part of the wall around the lumen at `seed`.
  [[nodiscard]] LocalSurface surface(const Eigen::Vector3d& seed) const;

private:
  [[nodiscard]] double at(int x, int y, int z) const;
  [[nodiscard]] double knownSide(int x, int y, int z) const;

  const BoxedField& m_field;
  SampleGrid m_grid;
};

}  // namespace lumen::convert
