// SPDX-License-Identifier: Apache-2.0
// The arrays of a blob_model, laid out for queries and never changed after construction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "blob.h"
#include "formats/field/kernel.h"

namespace lumen::blob {

constexpr int kLanes = 8;
constexpr double kFarthestMm = 1e9;  ///< mm from a node; beyond, f counts as zero
constexpr float kVanished = 1e-20f;  ///< mm; below, the terms of grad f may underflow

/// The number that a caller in C has stored in an enumeration, which may be none of its values.
template <class Enumeration>
int codeOf(const Enumeration& stored) noexcept {
  static_assert(sizeof stored == sizeof(int));
  int code;
  std::memcpy(&code, &stored, sizeof code);
  return code;
}

/// The field::Kernel of a checked kernel.
inline field::Kernel kernelOf(blob_kernel kernel) noexcept {
  return static_cast<field::Kernel>(kernel);
}

/// Eight blobs relative to their node's centre. Padding has a = w = 0 and adds exactly nothing.
struct alignas(32) BlobBlock {
  float x[kLanes], y[kLanes], z[kLanes];  ///< mm
  float a[kLanes];                        ///< factor of |X - C|^2: p / w^2, or 1 / w^2
  float w[kLanes];                        ///< mm
};

/// Eight neighbours k of a node i and the radical planes between: p_k - p_i = n . (X - O_i) + c,
/// in square millimetres. Padding has n = 0, a c that no point undercuts, and no node. A node has one block at
/// least; its neighbours ascend by the distance from the node at which they begin to blend with it.
struct alignas(32) NeighbourBlock {
  float nx[kLanes], ny[kLanes], nz[kLanes], c[kLanes];
  float inverseTau[kLanes];  ///< 1 / tau_ik of the blending weights, 1/mm^2
  std::uint32_t node[kLanes];
};

/// Location of the blobs that answer for a node.
struct FieldNode {
  float place[4];  ///< the node's centre relative to the origin of the blocks, and its radius, mm
  std::uint32_t block;
  std::uint32_t blockCount : 31;  ///< at most BLOB_MAX_BLOBS
  std::uint32_t isSimple : 1;     ///< one block, and `place` is zero
};
static_assert(sizeof(FieldNode) == 24, "part of a NodeRecord");

constexpr float kNeverLess = 3e38f;  ///< the power difference of padding, mm^2

inline bool isPadding(const NeighbourBlock& block, int lane) noexcept {
  return block.c[lane] == kNeverLess;
}

struct alignas(64) NodeRecord {
  /// mm, LPS; then the square of the distance from the centre within which only the first block of
  /// neighbours counts, mm^2
  double centre[4];
  FieldNode field;
  std::uint32_t firstNeighbours, neighbourBlocks;  ///< into the model's blocks of neighbours

  [[nodiscard]] float radius() const noexcept { return field.place[3]; }
  [[nodiscard]] double quietSquare() const noexcept { return centre[3]; }
};
static_assert(sizeof(NodeRecord) == 64, "one cache line");

/// The implicit functions of all nodes.
struct Field {
  blob_kernel kernel = BLOB_CAUCHY;
  double kernelParameter = 0, isoLevel = 0;
  double transformedLevel = 0;  ///< h at the iso-level, see field::levelTransform()
  std::vector<BlobBlock> blocks;
};

/// Boxes about the centres of eight children of an 8-ary tree over the nodes, and their greatest radii; a
/// child that does not exist has a radius of kNoChild.
struct alignas(64) LocateBlock {
  float low[3][kLanes], high[3][kLanes], radius[kLanes];  ///< mm
};
/// Eight nodes. Padding is at kFarAway, with a radius of zero.
struct alignas(64) LocateLeaf {
  float centre[3][kLanes], radius[kLanes];  ///< mm
  std::uint32_t node[kLanes];
};
constexpr float kFarAway = 3e18f;  ///< mm, beyond every node, with a square that is finite
constexpr float kNoChild = -1.0f;

/// levels.back() is searched as a whole; child c of block b of a level is block 8 b + c of the
/// level below, or leaf 8 b + c of the lowest.
struct LocateTree {
  static constexpr std::size_t kMostRoots = 4;  ///< blocks of levels.back()
  std::vector<LocateLeaf> leaves;
  std::vector<std::vector<LocateBlock>> levels;
};

struct Backend;

}  // namespace lumen::blob

struct blob_model {
  std::vector<lumen::blob::NodeRecord> nodes;
  std::vector<lumen::blob::NeighbourBlock> neighbours;
  lumen::blob::Field field;
  lumen::blob::LocateTree locate;
  std::vector<std::int32_t> parent;
  std::vector<std::array<std::uint32_t, 2>> links;  ///< edges besides those to parents
  std::vector<std::uint32_t> lender;  ///< the node whose blobs answer, or BLOB_NOWHERE
  std::size_t blobCount = 0;
  double low[3]{}, high[3]{};            ///< box of the nodes' balls, mm
  double reachLow[3]{}, reachHigh[3]{};  ///< a box that holds every wall, mm
  blob_simd simd = BLOB_SIMD_SCALAR;
  const lumen::blob::Backend* backend = nullptr;
  bool isPosed = false;  ///< owned by a blob_pose
};
