// SPDX-License-Identifier: Apache-2.0
// Points on the axis of an instrument's beams, and the values that are carried along with them when
// the beams change.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <BeamAdapter/component/BaseBeamInterpolation.h>
#include <sofa/defaulttype/RigidTypes.h>

namespace lumensofa {

using Rigid3 = sofa::defaulttype::Rigid3Types;
using Beams = beamadapter::BaseBeamInterpolation<Rigid3>;
using Vec3 = sofa::type::Vec3;

/// One point of a beam's cubic spline, with its Jacobian: a force d on it is the force weight * d
/// and the torque arm x d on each of the beam's two frames.
struct BeamSample {
  sofa::Index beam = 0;
  sofa::Index node[2] = {0, 0};  ///< frames
  double share = 0;              ///< share of the beam's length, 0 to 1
  double abscissa = 0;  ///< mm along the instrument from its handle; rises from sample to sample
  double radius = 0;    ///< mm
  double weight[2] = {0, 0};
  Vec3 arm[2];   ///< mm
  Vec3 tangent;  ///< unit vector towards the tip
};

/// `perBeam` samples on each beam that touches the wall: at shares 1/n, 2/n, ... 1, so one at the
/// tip and none at the first frame, which is held. Beams inside another instrument are left out.
/// `radius` 0: that of the section.
void layOutSamples(Beams& beams, unsigned perBeam, double radius, std::vector<BeamSample>& samples);

/// Positions (mm) of the samples for the frames `x`; with `jacobian`, their weights, arms and
/// tangents too.
void placeSamples(Beams& beams, const Rigid3::VecCoord& x, bool jacobian,
                  std::vector<BeamSample>& samples, std::vector<Vec3>& positions);

/// Index, for each new sample, of the old one that is nearest along the instrument, the first among
/// equals. Both rise; `oldAbscissa` is not empty. O(old + new).
void nearestAlong(std::span<const double> oldAbscissa, std::span<const BeamSample> samples,
                  std::vector<std::size_t>& nearest);

}  // namespace lumensofa
