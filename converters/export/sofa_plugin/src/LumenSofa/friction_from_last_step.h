// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sofa/core/behavior/ConstraintResolution.h>
#include <sofa/type/Vec.h>

namespace lumensofa {

/// SOFA's resolution of unilateral contact, with its Coulomb friction (three lines) if `friction`
/// is above 0, else one line, that begins with the force of the last step: `force`, in the world's
/// frame, which it writes after the solution. `axis`: the normal into the lumen and two tangents;
/// read here. `force` must outlive it.
sofa::core::behavior::ConstraintResolution* newResolution(double friction,
                                                          const sofa::type::Vec3 axis[3],
                                                          sofa::type::Vec3& force);

}  // namespace lumensofa
