// SPDX-License-Identifier: Apache-2.0
// All code that is compiled once for each set of SIMD instructions, on the vector types F4 and F8
// that the including file has declared in its namespace. Text, in this order; each part uses those
// before it.

// clang-format off
#include "simd/numbers.h"
#include "formats/field/kernel_formulas.h"
#include "formats/field/blend_formulas.h"
#include "simd/field.h"
#include "simd/blend.h"
#include "simd/locate_least.h"
#include "simd/wall_distance.h"
#include "simd/blend_group.h"
#include "simd/batch.h"
#include "simd/foot_lanes.h"
#include "simd/foot_search.h"
#include "simd/pose_nodes.h"
#include "simd/entry.h"
// clang-format on
