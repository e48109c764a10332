// SPDX-License-Identifier: Apache-2.0
// Pictures of a case: one, or those of a turntable.
#pragma once

#include <functional>
#include <string>

#include "converters/draw/picture/draw_case.h"
#include "converters/operations/context.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::operations {

struct PicturesOptions {
  convert::PictureOptions picture;  ///< its turn and scale are those of the turntable
  int turns = 0;  ///< pictures of a whole turn, at even angles and in one scale; 0: one, not turned
  const convert::Volume* behind = nullptr;  ///< its projection is drawn behind the vessels
  std::string behindName;                   ///< for messages
};

/// Draws the case, called `name`, and hands each picture to `take` when it is drawn, on the calling
/// thread, so that one is in memory at a time. A picture takes seconds at most, on all threads.
/// Throws Error(InvalidInput) for a case without models or a node or without the values that colours
/// are to show, and for a volume in which no node lies; what `take` throws; and Error(Cancelled).
void picturesOf(const formats::Case& value, const std::string& name, const PicturesOptions& options,
                const std::function<void(const convert::Picture&)>& take, const Context& context);

}  // namespace lumen::operations
