// SPDX-License-Identifier: Apache-2.0
// Differences between the shapes of sections within a case (docs/method.md, section 2.11).
#pragma once

#include <cstdint>
#include <span>

#include "converters/stages/fitting/image/sections.h"

namespace lumen::convert::fitting {

/// The spread of shapes among the fitted sections of `nodes`: for each kind of parameter the root of
/// the mean of the squares that the noise does not explain (empirical Bayes: H. Robbins, An empirical
/// Bayes approach to statistics, 1956), at most the usual spread. The usual one where fewer than
/// eight values are determined by voxels rather than by the prior. `fits`: one for each node of the
/// case.
ShapeSpread measureSpread(const Sections& sections, std::span<const SectionFit> fits,
                          std::span<const std::uint32_t> nodes);

}  // namespace lumen::convert::fitting
