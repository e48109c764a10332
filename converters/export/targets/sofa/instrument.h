// SPDX-License-Identifier: Apache-2.0
// Instruments as BeamAdapter takes them: rods of one material for each stretch. Units of a scene
// are mm, kg and s, so a modulus is in kPa and a force in mN. Sources of the values: docs/sofa.md.
#pragma once

#include <string>
#include <vector>

namespace lumen::convert {

/// A stretch of a rod.
struct RodSection {
  double length = 0;        ///< mm
  double youngModulus = 0;  ///< kPa, of a solid (or hollow) rod of that radius
  double radius = 0;        ///< mm
  double innerRadius = 0;   ///< mm
  double density = 0;       ///< kg / mm^3
  double beamLength = 0;    ///< mm, of a beam, which is also the spacing of contact points
  double curlDiameter = 0;  ///< mm, of the circles that it rests in; 0: straight
  double curlHeight = 0;    ///< mm, from one circle to the next
  [[nodiscard]] int beams() const;
};

struct Instrument {
  std::string name;         ///< a word
  double poissonRatio = 0;  ///< one for all sections
  /// Sections from handle to tip; only the first may be straight.
  std::vector<RodSection> sections;
  double color[3] = {1, 1, 1};
  [[nodiscard]] double length() const;  ///< mm
  [[nodiscard]] double radius() const;  ///< mm, the greatest
  [[nodiscard]] int beams() const;
};

enum class InstrumentKind { Guidewire, Catheter, Coil };

/// The instruments of a scene, the outermost first: a guidewire comes within a catheter. `length`,
/// mm, is the length that can be pushed in; a coil has its own length and rests in circles of
/// `curl`, mm.
std::vector<Instrument> makeInstruments(InstrumentKind kind, double length, double curl);

}  // namespace lumen::convert
