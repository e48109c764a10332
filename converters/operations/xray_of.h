// SPDX-License-Identifier: Apache-2.0
// The X-ray of a case.
#pragma once

#include <string>

#include "converters/draw/xray/draw_xray.h"
#include "converters/operations/context.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// Computed tomography around the vessels, and its name for messages.
struct XrayScan {
  const convert::Volume* volume = nullptr;  ///< null: water
  std::string name;
};

/// The X-ray of the case, called `name`, as convert::xrayOf() makes it. A picture takes seconds at
/// most, on all threads. Throws as it does, with the name of the part.
convert::XrayImage xrayOf(const formats::Case& value, const std::string& name,
                          const convert::XrayOptions& options, const XrayScan& scan,
                          const Context& context);

}  // namespace lumen::operations
