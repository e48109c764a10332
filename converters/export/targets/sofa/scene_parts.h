// SPDX-License-Identifier: Apache-2.0
// The parts of a scene, in the order of their creation. Each adds components to a node.
#pragma once

#include "converters/export/targets/sofa/scene.h"

namespace lumen::convert {

/// Where the instruments enter: mm, and a quaternion that turns x into their direction.
std::string entryPlace(const Insertion& insertion);
/// The animation loop, constraint solver and collision detection. Lengths in mm: the instruments'
/// radius, at which they are kept from a wall of triangles, and the alarm beyond it.
void addLoop(SceneItem& root, WallKind wall, double radius, double alarm);
/// Camera and light, for a box in mm, LPS.
void addView(SceneItem& root, const Box3d& box);
void addVessel(SceneItem& root, WallKind wall, const SceneInput& input);

/// A node with the sections of an instrument.
void addRestShape(SceneItem& root, const Instrument& instrument);
/// Time integration and the frames of all instruments.
void addBeamSolver(SceneItem& node, int frames);
void addBeams(SceneItem& node, const Instrument& instrument);
/// The springs that hold the instruments where they enter.
void addEntry(SceneItem& node);
void addBlobContact(SceneItem& node, const Instrument& instrument, double alarm);
/// Points along the instruments, recorded, and in contact with a wall of triangles, or with one of
/// a grid at `proximity`, mm.
void addContactPoints(SceneItem& node, WallKind wall, double proximity);
void addInstrumentView(SceneItem& node, const Instrument& instrument);

/// The plugins of the components that are in the scene, before all else.
void addPlugins(SceneItem& root);

}  // namespace lumen::convert
