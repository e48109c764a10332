// SPDX-License-Identifier: Apache-2.0
#include <BeamAdapter/component/WireBeamInterpolation.h>
#include <LumenSofa/beam_samples.h>

namespace lumensofa {
namespace {

// Range of a beam along the instrument, by its interpolation, or else after the beams before it.
struct BeamRange {
  double begin, end;
};

BeamRange beamRange(const Beams& beams, sofa::Index beam, double before) {
  const auto& placed = beams.d_curvAbsList.getValue();
  if (beam < placed.size()) return {placed[beam][0], placed[beam][1]};
  return {before, before + beams.d_lengthList.getValue()[beam]};
}

void addSamples(Beams& beams, sofa::Index beam, unsigned perBeam, double radius,
                std::vector<BeamSample>& samples) {
  const double before = samples.empty() ? 0 : samples.back().abscissa;
  const BeamRange stretch = beamRange(beams, beam, before);
  BeamSample sample;
  sample.beam = beam;
  sample.radius = radius > 0 ? radius : beams.getBeamSection(beam)._r;
  beams.getNodeIndices(beam, sample.node[0], sample.node[1]);
  for (unsigned k = 1; k <= perBeam; ++k) {
    sample.share = static_cast<double>(k) / perBeam;
    sample.abscissa = stretch.begin + sample.share * (stretch.end - stretch.begin);
    samples.push_back(sample);
  }
}

// Bernstein's polynomials of a cubic.
std::array<double, 4> bernstein(double t) {
  const double u = 1 - t;
  return {u * u * u, 3 * t * u * u, 3 * t * t * u, t * t * t};
}

// The inner control points stand on the frames: P1 = P0 + R0 (L/3, 0, 0), P2 = P3 - R1 (L/3, 0, 0).
void setJacobian(const std::array<double, 4>& b, const std::array<Vec3, 4>& spline,
                 const Vec3& first, const Vec3& last, BeamSample& sample) {
  sample.weight[0] = b[0] + b[1];
  sample.weight[1] = b[2] + b[3];
  const double t = sample.share, u = 1 - t;
  sample.tangent = (spline[1] - spline[0]) * (u * u) + (spline[2] - spline[1]) * (2 * t * u) +
                   (spline[3] - spline[2]) * (t * t);
  sample.tangent.normalize();
  sample.arm[0] = (spline[0] - first) * sample.weight[0] + (spline[1] - spline[0]) * b[1];
  sample.arm[1] = (spline[3] - last) * sample.weight[1] + (spline[2] - spline[3]) * b[2];
}

}  // namespace

void layOutSamples(Beams& beams, unsigned perBeam, double radius,
                   std::vector<BeamSample>& samples) {
  samples.clear();
  const sofa::Size count = beams.getNumBeams();
  auto* wire = dynamic_cast<beamadapter::WireBeamInterpolation<Rigid3>*>(&beams);
  if (wire == nullptr || !wire->isControlled()) {
    for (sofa::Index beam = 0; beam < count; ++beam)
      addSamples(beams, beam, perBeam, radius, samples);
    return;
  }
  // the controller knows which beams are outermost
  for (const auto beam : beams.d_beamCollision.getValue())
    if (beam < count) addSamples(beams, beam, perBeam, radius, samples);
}

void placeSamples(Beams& beams, const Rigid3::VecCoord& x, bool jacobian,
                  std::vector<BeamSample>& samples, std::vector<Vec3>& positions) {
  positions.resize(samples.size());
  std::array<Vec3, 4> spline;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    BeamSample& sample = samples[i];
    if (i == 0 || sample.beam != samples[i - 1].beam)
      beams.getSplinePoints(sample.beam, x, spline[0], spline[1], spline[2], spline[3]);
    const std::array<double, 4> b = bernstein(sample.share);
    positions[i] = spline[0] * b[0] + spline[1] * b[1] + spline[2] * b[2] + spline[3] * b[3];
    if (jacobian)
      setJacobian(b, spline, x[sample.node[0]].getCenter(), x[sample.node[1]].getCenter(), sample);
  }
}

void nearestAlong(std::span<const double> oldAbscissa, std::span<const BeamSample> samples,
                  std::vector<std::size_t>& nearest) {
  nearest.resize(samples.size());
  std::size_t at = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double here = samples[i].abscissa;
    while (at + 1 < oldAbscissa.size() &&
           std::abs(oldAbscissa[at + 1] - here) < std::abs(oldAbscissa[at] - here))
      ++at;
    nearest[i] = at;
  }
}

}  // namespace lumensofa
