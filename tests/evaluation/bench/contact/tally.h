// SPDX-License-Identifier: Apache-2.0
// Errors of a method, counted and not judged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "exact_field.h"
#include "method.h"
#include "wires.h"

namespace lumen::bench {

/// Radius of a 0.014 inch guidewire, mm.
constexpr double kWireRadius = 0.178;
/// Share of the vessel's radius below which differences are not counted.
constexpr double kTolerance = 0.05;

/// True distance and radius at a point.
struct Truth {
  double distance = 0;  ///< mm, negative in the lumen
  double radius = 0;    ///< of the vessel, mm
};

struct Tally {
  std::size_t points = 0;         ///< of wires
  std::size_t wrongSigns = 0;     ///< inside and outside taken for each other, beyond the tolerance
  std::size_t falseContacts = 0;  ///< said to touch, though free by more than the tolerance
  std::size_t missed = 0;         ///< said to be free, though touching by more than the tolerance
  std::size_t kisses = 0;         ///< points pushed through the wall into a vessel that touches
  std::size_t leaks = 0;          ///< of those, said to be inside
};

/// Counts wrong signs and contacts of a wire of kWireRadius. A distance that is no number touches, and is
/// outside.
void countWires(const std::vector<Truth>& truth, const double* distance, Tally& tally);

/// Truth at each point of a frame with N environments.
std::vector<Truth> computeTruth(const ExactField& exact, const Wires& wires, std::size_t frame,
                                std::size_t environments);

/// A point of a tool that is pushed out of its vessel.
struct Kiss {
  std::uint32_t station;  ///< the node of its own vessel
  double inside[3];       ///< where it comes from, in its own lumen
  double pushed[3];       ///< outside of its own vessel, and in the lumen of another one
};

/// Looks for places where vessels touch: rays across the vessel from random nodes. Beyond the wall, no
/// farther than half a radius, the first point that is outside of its own vessel and inside of another
/// one, both by more than the tolerance. At most `wanted`, in `rays` tries.
std::vector<Kiss> findKisses(const ExactField& exact, const formats::CenterlineTree& tree,
                             std::size_t rays, std::size_t wanted);

/// Lets a method follow each point from inside to where it is pushed, in one step, and counts leaks.
void countLeaks(Method& method, const std::vector<Kiss>& kisses, Tally& tally);

}  // namespace lumen::bench
