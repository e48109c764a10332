// SPDX-License-Identifier: Apache-2.0
// A case as a scene of MuJoCo 3: vessels with a solid wall, and a guidewire that an actuator pushes
// into them.
#pragma once

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// scene.xml, whose wire bends by the plugin mujoco.elasticity.cable; scene-joints.xml, that scene
/// for engines without plugins; meshes/wall_K.stl. Metres. The solid is all that is not lumen, or
/// with a thickness in the options a wall of it, within reach of the wire. Throws as lumenSurface()
/// and findInsertion().
ExportResult exportMujoco(const ExportInput& input);

TargetRow mujocoRow();

}  // namespace lumen::convert
