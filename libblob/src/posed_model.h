// SPDX-License-Identifier: Apache-2.0
// A model whose nodes move, and what is kept to write it again without memory or search.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "blob_pose.h"
#include "formats/field/neighbourhood.h"
#include "model.h"
#include "rotation.h"

namespace lumen::blob {

/// The place of a node that is posed, as a back end reads eight at once: centre and radius, mm.
struct alignas(16) PosedPlace {
  float number[4];
};

/// The rotation R of a posed node, without its factor, as a back end reads it to find strains.
struct alignas(16) PosedRotation {
  float quaternion[4];
};

/// An edge as it was when the tables of neighbours were made.
struct alignas(16) EdgeReference {
  float from[3],
      inverseLength;  ///< the edge in its first node's frame, over the factor; 1 over its length at rest
  float to[3], radius;  ///< the same in its second node's; the greater radius at rest, mm
  float turn[4];        ///< the rotation of the second node in the first one's frame
  std::uint32_t node[2];
};

/// The kinds of the lanes of a NeighbourBlock: 1 for an edge, 0 for another neighbour, -1 for
/// padding.
struct alignas(32) LaneKinds {
  float kind[kLanes];
};

using field::NodePose;

/// Indices without repetition, in memory that was taken before.
class IndexSet {
public:
  explicit IndexSet(std::size_t size) : m_mark(size, 0) { m_list.reserve(size); }
  void clear() noexcept {
    m_list.clear();
    ++m_round;
    if (m_round != 0) return;
    m_mark.assign(m_mark.size(), 0);  // after 2^32 - 1 rounds
    m_round = 1;
  }
  void add(std::uint32_t index) noexcept {
    if (m_mark[index] == m_round) return;
    m_mark[index] = m_round;
    m_list.push_back(index);
  }
  [[nodiscard]] const std::vector<std::uint32_t>& list() const noexcept { return m_list; }

private:
  std::vector<std::uint32_t> m_mark, m_list;
  std::uint32_t m_round = 1;
};

}  // namespace lumen::blob

struct blob_pose {
  const blob_model* rest = nullptr;
  blob_model model;
  double strainLimit = 0;
  bool renews = true;

  std::vector<lumen::blob::NodePose> pose;
  std::vector<lumen::blob::PosedPlace> place;
  std::vector<lumen::blob::PosedRotation> rotation;
  std::vector<float> inverseFactor;
  std::vector<lumen::blob::EdgeReference> edgeReference;
  std::vector<float> spacing;  ///< greatest square of an edge's length, mm^2
  std::vector<float>
      reach;  ///< mm from a node's centre at rest, beyond which its blobs stay below T
  std::vector<lumen::blob::LaneKinds> laneKinds;  ///< one for each block of neighbours
  std::vector<std::uint32_t> leafSlot;
  std::vector<std::array<std::uint32_t, 2>> borrowers;  ///< lender and borrower, ascending
  lumen::field::Neighbourhood edges;
  std::vector<std::uint32_t> edgeAt;  ///< into edgeReference, for each entry of edges.node

  /// Used while nodes are set: nodes whose blobs moved, nodes whose neighbours did, edges at the
  /// former; then the children that have other bounds, one set for each level.
  lumen::blob::IndexSet changed{0}, dirty{0}, strained{0};
  std::vector<lumen::blob::IndexSet> children;
};

/// The poses of some nodes of a case over time.
struct blob_motion {
  std::size_t caseNodes = 0;
  double period = 0;         ///< s; 0: not periodic
  std::vector<double> time;  ///< s, ascending, at least one
  std::vector<std::uint32_t> node;
  std::vector<lumen::blob::NodePose> pose;  ///< time by time, one for each entry of `node`
};

namespace lumen::blob {

/// Makes a pose of a model. Throws std::bad_alloc and nothing else.
std::unique_ptr<blob_pose> makePose(const blob_model& rest, const blob_pose_def& def);

/// Whether all numbers of a transform are in their ranges.
bool isTransform(const blob_transform& transform) noexcept;
NodePose poseOf(const blob_transform& transform) noexcept;
blob_transform transformOf(const NodePose& pose) noexcept;

/// Moves the nodes of pose.changed to pose.pose: blobs, centres, neighbours, lenders, boxes.
void moveNodes(blob_pose& pose) noexcept;

/// The greatest strain of the edges at the nodes of pose.changed, see blob_pose_strain().
double strainOfChange(blob_pose& pose) noexcept;

/// Makes the tables of neighbours anew. Throws std::bad_alloc, and leaves the pose as it was.
void renewNeighbours(blob_pose& pose);

/// The least rotation of a node's surroundings that turns its direction at rest into that of the
/// centres in pose.place.
Quaternion rotationFromCentres(const blob_pose& pose, std::uint32_t node) noexcept;

}  // namespace lumen::blob
