// SPDX-License-Identifier: Apache-2.0
// The wall that a mesh of a whole case follows: that of the blended field, kept off other vessels.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"
#include "formats/field/blended_field.h"

namespace lumen::convert {

/// Where the wall lies; lengths in mm.
struct SheetOptions {
  /// Distance that two vessels keep where their walls touch or overlap.
  double gap = 0;
  /// How far outside of the lumen's wall the surface lies: 0, or a wall's thickness.
  double offset = 0;
  /// The same as a share of the local radius; added to `offset`.
  double offsetShare = 0;
};

/// What SheetField says of a point.
struct SheetSample {
  double distance = 0;  ///< to the surface, about, mm; negative inside
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< unit, out of the lumen
  std::uint32_t node = 0;                              ///< at which following the point ends
  bool isSeparated = false;  ///< here the surface keeps off another vessel and is not f = T
};

/// The signed distance to the surface of a case, for a point reached along the tree (docs/method.md,
/// section 5). Never changed after construction: any number of threads may ask.
class SheetField {
public:
  /// `source` has models and, with `field`, must stay.
  SheetField(const formats::Case& source, const field::BlendedField& field,
             const SheetOptions& options);

  /// For a cursor that begins at `node` and follows.
  [[nodiscard]] SheetSample at(const Eigen::Vector3d& point, std::uint32_t node) const;

  /// The point of the surface that Newton's method reaches from `start`, within 1e-4 of the local
  /// radius; `sample` is what at() says there. With `plane`, a unit vector, it stays in the plane
  /// through `start` normal to it. Nothing if there is no surface near by.
  struct Foot {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    SheetSample sample;
  };
  [[nodiscard]] std::optional<Foot> project(const Eigen::Vector3d& start, std::uint32_t node,
                                            const Eigen::Vector3d* plane = nullptr) const;

  /// The radius of the vessel at a node, mm.
  [[nodiscard]] double radius(std::uint32_t node) const { return m_source.tree.radius[node]; }
  [[nodiscard]] const formats::Case& source() const { return m_source; }
  [[nodiscard]] const field::BlendedField& field() const { return m_field; }
  [[nodiscard]] const SheetOptions& options() const { return m_options; }

private:
  const formats::Case& m_source;
  const field::BlendedField& m_field;
  SheetOptions m_options;
};

}  // namespace lumen::convert
