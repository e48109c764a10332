// SPDX-License-Identifier: Apache-2.0
// The steady pressures that a network of vessels leads to, before a solver finds them.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "converters/base/warning.h"
#include "converters/export/shared/network.h"

namespace lumen::convert::blood {

// Properties of blood and of arteries' walls in exports for flow solvers, in SI units. A case knows
// neither, so users replace them where they know better.

/// kg/m^3 and Pa s: the defaults of SimVascular's solvers. Blood is Newtonian in them.
constexpr double kDensity = 1060;
constexpr double kViscosity = 0.004;

/// m/s, over the section of an inlet and the heart's cycle: arteries from the aorta to those of the
/// brain have 0.1 to 0.4 (Caro et al., The mechanics of the circulation, 2012).
constexpr double kMeanVelocity = 0.2;

/// Pa, in the middle of outlets: 100 mmHg.
constexpr double kMeanPressure = 13332;

/// Thickness of a wall as a share of the inner radius; only where a solver wants modulus and
/// thickness apart.
constexpr double kThickness = 0.1;

/// E h / r in Pa of an artery with the radius `r` in m: k1 exp(k2 r) + k3 (Olufsen, Structured tree
/// outflow condition for blood flow in larger systemic arteries, Am J Physiol 276, 1999).
constexpr double kStiffness1 = 2e6, kStiffness2 = -2252.67, kStiffness3 = 8.65e4;

/// s, in which pressure behind an outlet falls by 1/e: in diastole 1 to 2 (Westerhof, Lankhaar,
/// Westerhof, The arterial Windkessel, Med Biol Eng Comput 47, 2009).
constexpr double kDecay = 1.5;

inline double stiffness(double r) {
  return kStiffness1 * std::exp(kStiffness2 * r) + kStiffness3;
}

/// m^3/s, in the mean, through an inlet with the radius `r` in m.
inline double meanFlow(double r) {
  return kMeanVelocity * std::numbers::pi * r * r;
}

/// Share of a flow that an outlet takes: r^3 (Murray, The physiological principle of minimum work,
/// PNAS 12, 1926).
inline double murrayShare(double r) {
  return r * r * r;
}

}  // namespace lumen::convert::blood

namespace lumen::convert {

/// Pa, at each joint, of the steady flow that the exported boundary conditions state:
/// blood::meanFlow() into each inlet, outletResistances() behind outlets, lumped().resistance
/// between joints.
std::vector<double> steadyPressures(const FlowNetwork& network);

/// Pa, at each joint, of a steady flow with lumped().resistance between joints; `into`: m^3/s that
/// flow into each joint from outside, which sum to 0 in each tree; `zero`: a joint of each tree at
/// which the pressure is 0.
std::vector<double> pressuresOfFlows(const FlowNetwork& network, const std::vector<double>& into,
                                     const std::vector<std::uint32_t>& zero);

/// A warning for each inlet whose steady pressure no artery has, with the segment that takes most of
/// it; labels as they are.
std::vector<Warning> pressureWarnings(const FlowNetwork& network);

}  // namespace lumen::convert
