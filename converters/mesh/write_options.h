// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lumen::convert {

/// What a mesh format may be asked for; each takes what concerns it.
struct WriteMeshOptions {
  bool draco = false;          ///< glTF only: KHR_draco_mesh_compression
  int dracoPositionBits = 14;  ///< quantisation of a branch's bounding box, 1 .. 30
  int dracoNormalBits = 10;    ///< quantisation of a normal, 2 .. 30
};

}  // namespace lumen::convert
