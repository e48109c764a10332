// SPDX-License-Identifier: Apache-2.0
// The canonical model that converters read and write, whatever the file format.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "formats/field/kernel.h"
#include "formats/field/vec3f.h"

namespace lumen::formats {

enum class BranchKind : std::uint8_t { Vessel = 0, Aneurysm = 1 };

/// Reason why tracking of a branch ended. Values are stored in files: append only.
enum class StopReason : std::uint8_t {
  Unknown = 0,          ///< not recorded, or the branch was not tracked from a volume
  NoValidCylinder = 1,  ///< no cylinder reached half of the accepting inlier rate
  TurnedBack = 2,       ///< the next centre lay on the path already tracked
  LeftVolume = 3,       ///< the next centre lay outside the volume
  MetBranch = 4,        ///< the next centre lay in another branch's lumen
  EndOfSeeds = 5,       ///< an aneurysm: every given point was used
  StepLimit = 6,        ///< the bound on nodes in one branch
};

constexpr std::int32_t kNoParent = -1;

/// A contiguous range of nodes [firstNode, firstNode + nodeCount), each the child of the one
/// before.
struct Branch {
  std::string label;  ///< unique in its case, UTF-8
  BranchKind kind = BranchKind::Vessel;
  std::int32_t parentNode = kNoParent;  ///< parent of the first node; kNoParent for a root
  std::uint32_t firstNode = 0;
  std::uint32_t nodeCount = 0;
  StopReason stopReason = StopReason::Unknown;
  std::optional<float> meanInlierRate;  ///< mean of the nodes' inlier rates, in [0, 1]
  friend bool operator==(const Branch&, const Branch&) = default;
};

/// Nodes as a structure of arrays (all of nodeCount() entries; inlierRate may be empty), and their
/// branches in node order. A node's parent has a smaller index, so the parents make no cycle.
struct CenterlineTree {
  std::vector<Vec3f> centre;          ///< mm, LPS
  std::vector<Vec3f> direction;       ///< unit vector along the vessel, away from the parent
  std::vector<float> radius;          ///< mm, > 0
  std::vector<float> height;          ///< mm, >= 0: length of the node's cylinder along `direction`
  std::vector<std::int32_t> parent;   ///< node index, or kNoParent
  std::vector<std::uint32_t> branch;  ///< index into `branches`
  std::vector<float> inlierRate;      ///< in [0, 1]; empty if unknown
  std::vector<Branch> branches;
  /// Pairs of nodes that are neighbours although neither is the other's parent, where vessels close
  /// a loop; the smaller first, in ascending order.
  std::vector<std::array<std::uint32_t, 2>> links;

  [[nodiscard]] std::size_t nodeCount() const { return centre.size(); }
  friend bool operator==(const CenterlineTree&, const CenterlineTree&) = default;
};

/// Robust points on the wall: node i owns position[offset[i]] .. position[offset[i + 1] - 1].
struct PointSets {
  std::vector<std::uint32_t> offset;  ///< nodeCount() + 1 entries, non-decreasing, first 0
  std::vector<Vec3f> position;        ///< mm, LPS
  friend bool operator==(const PointSets&, const PointSets&) = default;
};

using field::Kernel;

/// One implicit surface f(X) = T per node, f(X) = sum_j width_j * phi(|X - centre_j|^2 /
/// width_j^2), inside where f > T. Node i owns the blobs offset[i] .. offset[i + 1] - 1.
struct BlobbyModels {
  Kernel kernel = Kernel::Cauchy;
  double kernelParameter = 0.2;  ///< Cauchy: s^2; Gaussian: a^2; ignored by the compact kernels
  double isoLevel = 0.1;         ///< T, mm
  std::vector<std::uint32_t> offset;
  std::vector<Vec3f> centre;  ///< mm, LPS
  std::vector<float> width;   ///< mm, > 0
  friend bool operator==(const BlobbyModels&, const BlobbyModels&) = default;
};

/// Place of a node at a time: a point X of the node at rest is carried to
/// centre + factor * R (X - its centre at rest), R being the matrix of `rotation`.
struct Pose {
  Vec3f centre;                               ///< mm, LPS
  std::array<float, 4> rotation{0, 0, 0, 1};  ///< unit quaternion x, y, z, w
  float factor = 1;                           ///< > 0, of the radius
  friend bool operator==(const Pose&, const Pose&) = default;
};

/// Poses of some nodes over time; all other nodes rest. The pose of node[n] at time[t] is
/// pose[t * node.size() + n].
struct Motion {
  std::vector<double> time;  ///< s, ascending, at least one
  double period = 0;         ///< s; longer than from the first time to the last, or 0: not periodic
  std::vector<std::uint32_t> node;  ///< node indices, ascending
  std::vector<Pose> pose;
  friend bool operator==(const Motion&, const Motion&) = default;
};

/// Geometry of the volume that a case was made from.
struct SourceVolume {
  std::array<std::uint32_t, 3> size{};  ///< voxels along i, j, k
  std::array<double, 3> spacing{};      ///< mm along i, j, k
  std::array<double, 3> origin{};       ///< centre of voxel (0,0,0), mm, LPS
  std::array<double, 9> direction{};  ///< row-major; column a is the LPS direction of index axis a
  std::string sha256;  ///< lower-case hex digest of the voxels (see the specification)
  friend bool operator==(const SourceVolume&, const SourceVolume&) = default;
};

using ParameterValue = std::variant<bool, std::int64_t, double, std::string>;

/// One processing step with every parameter value that it used.
struct Step {
  std::string name;  ///< "track", "fit", "phantom", ...
  std::string tool;  ///< "lumen 0.2.0"
  std::map<std::string, ParameterValue> parameters;
  friend bool operator==(const Step&, const Step&) = default;
};

/// Rounding of wall points: to multiples of `step` from a corner of their bounding box.
struct PointQuantisation {
  std::int32_t bits = 0;  ///< 1 to 30
  double step = 0;        ///< mm, > 0
  friend bool operator==(const PointQuantisation&, const PointQuantisation&) = default;
};

/// Provenance of a case. It deliberately has no field for a person, a date or a path.
struct Metadata {
  std::optional<double> voxelSize;  ///< mm: geometric mean of the spacing of the source volume
  std::optional<SourceVolume> source;
  std::string parentSha256;  ///< digest of the case file that this one was made from, or empty
  std::optional<PointQuantisation> pointQuantisation;  ///< absent if the points are as measured
  std::string note;                                    ///< for people, UTF-8
  std::vector<std::string> extensionsUsed;
  std::vector<std::string> extensionsRequired;  ///< a subset of extensionsUsed
  std::vector<Step> steps;                      ///< oldest first
  friend bool operator==(const Metadata&, const Metadata&) = default;
};

/// Values of an extension: `components` consecutive numbers for each node.
struct NodeArray {
  std::string name;  ///< EXTENSION.name
  std::uint32_t components = 1;
  std::string unit;  ///< for people; may be empty
  std::variant<std::vector<float>, std::vector<std::int32_t>, std::vector<std::uint32_t>> values;
  friend bool operator==(const NodeArray&, const NodeArray&) = default;
};

/// A chunk that this code does not know, kept so that rewriting a file loses nothing.
struct OtherChunk {
  std::string type;  ///< four ASCII letters or digits
  std::uint16_t version = 1;
  bool independent = false;  ///< stays right when the nodes, points or models change
  std::uint8_t encoding = 0;
  std::uint64_t rawSize = 0;       ///< bytes once decoded; bytes.size() for encoding 0
  std::vector<std::byte> bytes{};  ///< as they are stored
  friend bool operator==(const OtherChunk&, const OtherChunk&) = default;
};

struct Case {
  Metadata metadata;
  CenterlineTree tree;
  std::optional<PointSets> points;
  std::optional<BlobbyModels> models;
  std::optional<Motion> motion;
  std::vector<NodeArray> nodeArrays;
  std::vector<OtherChunk> otherChunks;
  friend bool operator==(const Case&, const Case&) = default;
};

}  // namespace lumen::formats
