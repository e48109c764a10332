// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/openfoam/waveform.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace lumen::convert {

namespace {

struct Harmonic {
  double flow;   ///< ml/s
  double phase;  ///< rad
};
constexpr double kMean = 6.5;  // ml/s
constexpr std::array<Harmonic, 11> kHarmonics = {{{3.294, -0.023974},
                                                  {1.9262, -1.1801},
                                                  {-1.4219, 0.92701},
                                                  {-0.66627, -0.24118},
                                                  {-0.33933, -0.27471},
                                                  {-0.37914, -1.0557},
                                                  {0.22396, 1.22},
                                                  {0.1507, 1.0984},
                                                  {0.18735, 0.067483},
                                                  {0.038625, 0.22262},
                                                  {0.012643, -0.10093}}};

}  // namespace

double carotidFlow(double time) {
  double flow = kMean;
  for (std::size_t n = 0; n < kHarmonics.size(); ++n)
    flow += kHarmonics[n].flow *
            std::sin(2 * std::numbers::pi * static_cast<double>(n + 1) * time / kCycle +
                     kHarmonics[n].phase);
  return flow / kMean;
}

}  // namespace lumen::convert
