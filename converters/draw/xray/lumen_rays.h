// SPDX-License-Identifier: Apache-2.0
// The stretches of an X-ray's rays that lie in the lumen of a case.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "converters/base/progress.h"
#include "converters/draw/xray/xray_view.h"
#include "converters/geometry/case_model.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// A stretch of a ray in the lumen, mm from the source.
struct Chord {
  double from = 0, to = 0;
};

/// Receives a pixel, by its place from the left and the top, and the stretches of its ray in the
/// lumen, which are apart and ascend.
using TakeRay = std::function<void(int x, int y, std::span<const Chord>)>;

/// Intersections of rays with the blended wall: each node's ball is cut by the sides of its power
/// cell, the distance is sampled at quarters of the radius along what is left, and each change of
/// its sign is found by a secant (docs/xray.md).
class LumenRays {
public:
  /// `source` has models and a node, and must stay. Throws as openModels().
  explicit LumenRays(const formats::Case& source);

  /// Calls `take` once for each pixel, from any thread, in rows of one thread. The bits do not
  /// depend on the number of threads. Throws as requireBetween(), and Error(Cancelled).
  void cast(const XrayView& view, Progress& progress, const TakeRay& take) const;

private:
  const formats::CenterlineTree& m_tree;
  OwnedModel m_model;
};

}  // namespace lumen::convert
