// SPDX-License-Identifier: Apache-2.0
// Reference of the benchmark: the distance to the wall of the case for a tool whose place along the tree is
// known.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "formats/case/case.h"
#include "method.h"

namespace lumen::bench {

/// The blended field of a case (docs/method.md, 3), by the scalar reference: its sign in doubles, its
/// distance that to the nearest point of the wall. Which of its sheets is meant is not left to what a
/// cursor has been through: a node of the tree is given, the station, on whose axis the point was made.
class ExactField {
public:
  explicit ExactField(const formats::Case& source);

  /// Signed distance to the wall, mm, negative in the lumen, at the node that the tree leads to from the
  /// station.
  [[nodiscard]] double distance(std::uint32_t station, const double* point) const;

  /// Signed distance to the wall, mm, at the node of least power of the station's vessel: the nodes that
  /// are no farther along the tree than four times the sum of both radii, as far as nodes can be
  /// neighbours. All others are other vessels, however near. No walk is made.
  [[nodiscard]] double ownDistance(std::uint32_t station, const double* point) const;

  /// Signed distance to the wall, mm, of the other vessel that is nearest to a point: that of the node of
  /// least power among those that are not of the station's vessel; that node. Infinite if there is none.
  struct Other {
    double distance;
    std::uint32_t node;
  };
  [[nodiscard]] Other otherVessel(std::uint32_t station, const double* point) const;

  [[nodiscard]] double radius(std::uint32_t node) const { return m_radius[node]; }
  [[nodiscard]] const blob_model* model() const { return m_model.get(); }
  /// The nodes of a station's vessel, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& vesselOf(std::uint32_t station) const {
    return m_vessel[station];
  }

private:
  [[nodiscard]] double power(std::uint32_t node, const double* point) const;
  [[nodiscard]] double distanceAt(std::uint32_t node, const double* point) const;

  std::shared_ptr<blob_model> m_model;
  double m_level;
  std::vector<double> m_centre, m_radius;
  std::vector<std::vector<std::uint32_t>> m_vessel;
};

}  // namespace lumen::bench
