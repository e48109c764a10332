// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sofa/core/objectmodel/BaseObject.h>

namespace lumensofa {

/// Marks a component as invalid and stops its scene: no step is to run as if there were no wall.
void stopScene(sofa::core::objectmodel::BaseObject& component);

}  // namespace lumensofa
