// SPDX-License-Identifier: Apache-2.0
// The four shapes of Yureidini's thesis, 4.8.2: convolution surfaces of point skeletons, all of
// radius 1 mm.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "converters/base/random.h"
#include "formats/case/case.h"
#include "implicit_surface.h"

namespace lumen::reproduce {

struct ConvolutionShape {
  std::string name;
  std::vector<Vector3d> skeleton;  ///< mm
  formats::BlobbyModels model;     ///< one node: the skeleton's blobs
  std::size_t startBlobs = 2;      ///< N_bi of table 4.6
  bool open = false;               ///< only what lies within the box below is sampled and judged

  [[nodiscard]] ImplicitSurface surface() const { return {model, 0}; }
  /// The clipping box of the open capsule.
  [[nodiscard]] bool contains(const Vector3d& p) const;
  /// About 300 even points of the wall, within the box.
  [[nodiscard]] std::vector<Vector3d> samples(Random& random) const;
};

/// Arc, bifurcation, capsule, open capsule. The thesis states the widths of the blobs too, but they
/// do not give the radius that it states; they are solved for here: one width for each arc, by
/// which its surface is 1 mm from the middle of its skeleton, and for the bifurcation one for each
/// blob, by least squares on the union of its two arcs.
std::vector<ConvolutionShape> convolutionShapes();

/// A random point 1 mm from a random one of `skeleton`.
Vector3d besideSkeleton(const std::vector<Vector3d>& skeleton, Random& random);

// Even samples of an implicit surface (A. Witkin, P. Heckbert: Using particles to sample and
// control implicit surfaces, 1994), for a fixed number of particles.
struct ParticleOptions {
  std::size_t count = 300;
  int rounds = 60;
  double longestStep = 0.3;  ///< of Newton's method, mm
};

/// Points of the surface that repel each other within it. `seed` gives points near the surface to
/// begin with. Fewer than asked for only if hardly any seed reaches the surface.
std::vector<Vector3d> sampleSurface(const ImplicitSurface& surface,
                                    const std::function<Vector3d(Random&)>& seed,
                                    const ParticleOptions& options, Random& random);

}  // namespace lumen::reproduce
