// SPDX-License-Identifier: Apache-2.0
// Units of simulators in those of lumen, millimetres, and in SI units.
#pragma once

namespace lumen::convert {

inline constexpr double kMetres = 1e-3, kCentimetres = 0.1;  ///< in a millimetre
inline constexpr double kCgsResistance = 1e-5;               ///< dyn s/cm^5 of Pa s/m^3

}  // namespace lumen::convert
