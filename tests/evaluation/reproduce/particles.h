// SPDX-License-Identifier: Apache-2.0
// Even samples of an implicit surface (A. Witkin, P. Heckbert: Using particles to sample and
// control implicit surfaces, 1994), for a fixed number of particles.
#pragma once

#include <functional>
#include <vector>

#include "converters/base/random.h"
#include "implicit_surface.h"

namespace lumen::reproduce {

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
