// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/sofa/instrument.h"

#include <algorithm>
#include <cmath>

namespace lumen::convert {

namespace {

// Beams: where an instrument rests on a wall it curves like the vessel, and a chord of length L
// leaves an arc of radius R by L^2 / 8 R. 2 mm in a shaft is 0.1 mm at R = 5 mm, 1 mm in a tip at R
// = 1.25 mm.
constexpr double kShaftBeam = 2, kTipBeam = 1;

/// 0.014 inches: a core of nitinol, ground thin at the tip under a coil of platinum; the tip is
/// shaped to a bend.
Instrument guidewire(double length) {
  constexpr double kTip = 20;
  RodSection shaft{.length = length - kTip,
                   .youngModulus = 10e6,
                   .radius = 0.18,
                   .density = 6.45e-6,
                   .beamLength = kShaftBeam};
  RodSection tip{.length = kTip,
                 .youngModulus = 1e6,
                 .radius = 0.18,
                 .density = 6.45e-6,
                 .beamLength = kTipBeam,
                 .curlDiameter = 30};
  return {"guidewire", 0.33, {shaft, tip}, {0.25, 0.3, 0.85}};
}

/// A microcatheter, 2.4 F outside, 0.021 inches inside: polymer over a braid, softer at its end.
Instrument catheter(double length) {
  constexpr double kTip = 30, kAlmostStraight = 4000;
  RodSection shaft{.length = length - kTip,
                   .youngModulus = 1.5e6,
                   .radius = 0.4,
                   .innerRadius = 0.27,
                   .density = 1.2e-6,
                   .beamLength = kShaftBeam};
  RodSection tip{.length = kTip,
                 .youngModulus = 0.2e6,
                 .radius = 0.4,
                 .innerRadius = 0.27,
                 .density = 1.2e-6,
                 .beamLength = kTipBeam,
                 .curlDiameter = kAlmostStraight};
  return {"catheter", 0.4, {shaft, tip}, {0.85, 0.75, 0.4}};
}

/// A wire of platinum-tungsten, 0.045 mm, wound to 0.010 inches: as a spring it bends like a solid
/// rod of that width with a modulus of 9.5 MPa (docs/sofa.md).
Instrument coil(double curl) {
  constexpr double kStraight = 2, kLength = 120, kPitch = 0.5;
  RodSection start{.length = kStraight,
                   .youngModulus = 9.5e3,
                   .radius = 0.127,
                   .density = 11e-6,
                   .beamLength = kTipBeam};
  RodSection body = start;
  body.length = kLength - kStraight;
  body.curlDiameter = curl;
  body.curlHeight = kPitch;
  return {"coil", 0.38, {start, body}, {0.75, 0.75, 0.78}};
}

}  // namespace

int RodSection::beams() const {
  return std::max(1, static_cast<int>(std::lround(length / beamLength)));
}

double Instrument::length() const {
  double sum = 0;
  for (const RodSection& section : sections) sum += section.length;
  return sum;
}

double Instrument::radius() const {
  double greatest = 0;
  for (const RodSection& section : sections) greatest = std::max(greatest, section.radius);
  return greatest;
}

int Instrument::beams() const {
  int sum = 0;
  for (const RodSection& section : sections) sum += section.beams();
  return sum;
}

std::vector<Instrument> makeInstruments(InstrumentKind kind, double length, double curl) {
  switch (kind) {
    case InstrumentKind::Catheter:
      return {catheter(length)};
    case InstrumentKind::Coil:
      return {coil(curl)};
    case InstrumentKind::Guidewire:
      break;
  }
  return {catheter(length), guidewire(length)};
}

}  // namespace lumen::convert
