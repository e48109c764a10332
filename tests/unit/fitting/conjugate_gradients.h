// SPDX-License-Identifier: Apache-2.0
// The minimiser of Yureidini's thesis, as a reference: Polak-Ribiere conjugate gradients over all
// centres, then over all widths, in turn.
#pragma once

#include <vector>

#include "converters/stages/fitting/energy.h"

namespace lumen::test {

/// Returns the energy; `rounds` is 5 in the thesis. Every line search may take `steps` gradients.
double minimiseByConjugateGradients(convert::fitting::Energy& energy,
                                    std::vector<convert::fitting::Blob>& blobs, int rounds,
                                    int steps);

}  // namespace lumen::test
