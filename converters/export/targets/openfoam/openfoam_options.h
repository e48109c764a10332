// SPDX-License-Identifier: Apache-2.0
// Options of `lumen export openfoam` alone.
#pragma once

#include <cstdint>

namespace lumen::convert {

enum class FoamGrain : std::uint8_t { Coarse, Medium, Fine };
enum class FoamFlow : std::uint8_t { Steady, Pulsatile };

struct FoamOptions {
  FoamGrain cells = FoamGrain::Medium;
  FoamFlow flow = FoamFlow::Steady;
};

}  // namespace lumen::convert
