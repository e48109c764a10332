// SPDX-License-Identifier: Apache-2.0
// Differences between versions of SOFA, and the plugins of its components.
#pragma once

#include "converters/export/targets/sofa/scene_tree.h"

namespace lumen::convert {

/// Rewrites a scene for SOFA v23.06, which stEVE uses: components have their old names, and a
/// wire's material is stated at its WireRestShape.
void toV23_06(SceneItem& root);

/// The plugin of a component; empty for those of the core. A component that is not in the table is
/// a mistake of this library.
std::string sofaPlugin(const std::string& type);

}  // namespace lumen::convert
