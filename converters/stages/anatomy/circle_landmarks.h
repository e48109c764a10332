// SPDX-License-Identifier: Apache-2.0
// Where the circle of Willis lies in a network: inlets, ends of the carotid arteries, midplane.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/anatomy/usual.h"
#include "converters/stages/anatomy/vessel_network.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// One half of the circle.
struct HalfCircle {
  char letter = 'R';
  double sign = -1;  ///< of x away from the midplane
  std::uint32_t inlet = VesselNetwork::kNone;
  std::vector<std::uint32_t> course;  ///< from the inlet to the most lateral tip that it feeds
  /// Place in the course where the first segment of the anterior cerebral artery leaves.
  std::size_t terminus = 0;
  std::vector<std::uint32_t> a1;  ///< from there, without it, to the midline; empty: it is missing
  double plausible = 0;           ///< of the terminus; 0: there is none

  [[nodiscard]] std::string name(const char* vessel) const {
    return std::string{letter, '-'} + vessel;
  }
  [[nodiscard]] std::uint32_t end() const { return course[terminus]; }
  [[nodiscard]] bool isFound() const { return plausible > 0; }
  [[nodiscard]] bool hasA1() const { return !a1.empty(); }
};

struct CircleLandmarks {
  std::array<HalfCircle, 2> half;
  std::uint32_t basilar = VesselNetwork::kNone;  ///< the inlet of the basilar artery; kNone: none
  double middle = 0;                             ///< x of the midplane, mm
  double plausible = 0;  ///< of the pair of carotid arteries; 0: there is none

  [[nodiscard]] const HalfCircle& right() const { return half[0]; }
  [[nodiscard]] const HalfCircle& left() const { return half[1]; }
  /// Both halves have the first segment of an anterior cerebral artery.
  [[nodiscard]] bool isPair() const { return right().hasA1() && left().hasA1(); }
};

/// Places in a network of which some landmarks are known.
class CirclePlaces {
public:
  explicit CirclePlaces(const VesselNetwork& network, CircleLandmarks marks = {})
      : m_network(network), m_marks(std::move(marks)) {}

protected:
  [[nodiscard]] Eigen::Vector3d at(std::uint32_t n) const { return m_network.position(n); }
  [[nodiscard]] double x(std::uint32_t n) const { return at(n).x(); }
  [[nodiscard]] double y(std::uint32_t n) const { return at(n).y(); }
  [[nodiscard]] double z(std::uint32_t n) const { return at(n).z(); }
  /// mm from the midplane, positive on the side of a half.
  [[nodiscard]] double aside(std::uint32_t n, const HalfCircle& half) const {
    return half.sign * (x(n) - m_marks.middle);
  }

  const VesselNetwork& m_network;
  CircleLandmarks m_marks;
};

/// The landmarks of a network of these branches.
CircleLandmarks findCircleLandmarks(const VesselNetwork& network,
                                    const std::vector<formats::Branch>& branches);

}  // namespace lumen::convert
