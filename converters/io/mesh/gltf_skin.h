// SPDX-License-Identifier: Apache-2.0
// Skins and animations of glTF.
#pragma once

#include <span>
#include <vector>

#include "converters/io/mesh/gltf_document.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vertex_streams.h"
#include "converters/io/mesh/write_options.h"

namespace lumen::convert {

/// The surfaces in glTF's frame, metres with +y up: programs leave the transforms of a skinned mesh
/// out, so that vertices lie where joints at rest leave them.
std::vector<SurfaceMesh> inGltfFrame(std::span<const SurfaceMesh> levels);

/// Appends JOINTS_0 and WEIGHTS_0 of the vertices of parts.
void addSkinStreams(const MeshSkin::Vertices& vertices, std::span<const MeshPart> parts,
                    std::vector<VertexStream>& streams);

/// Adds the joints as children of node 0, whose matrix is kGltfFromLps, the skin, and an animation
/// with linear samplers, unless there is one time only; returns the index of the skin. The joints
/// stand in their poses at rest.
int addSkin(const MeshSkin& skin, GltfDocument& document);

}  // namespace lumen::convert
