// SPDX-License-Identifier: Apache-2.0
// The terms of local models.
#pragma once

namespace lumen::convert::fitting {

/// One term width * phi(|X - centre|^2 / width^2) of the model, in the fit's frame (see energy.h).
struct Blob {
  double x = 0, y = 0, z = 0, width = 0;
};

}  // namespace lumen::convert::fitting
