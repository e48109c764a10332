// SPDX-License-Identifier: Apache-2.0
// A case used in place: spans into the bytes of a `.lumen` file, such as a mapped one. Standard
// library only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "formats/container/container.h"
#include "formats/view/case_chunks.h"
#include "formats/view/float3.h"

namespace lumen::formats {

/// One implicit surface per node; see BlobbyModels in formats/case/case.h.
struct ModelView {
  std::uint8_t kernel = 0;  ///< a field::Kernel, once checked
  double kernelParameter = 0, isoLevel = 0;
  std::span<const std::uint32_t> offset;  ///< one per node, and one more
  std::span<const Float3> centre;         ///< mm, LPS
  std::span<const float> width;           ///< mm
};

/// A pose in a file: centre x, y, z (mm); rotation x, y, z, w; factor.
using PoseRecord = std::array<float, 8>;

/// The motion of some nodes; see Motion in formats/case/case.h.
struct MotionView {
  double period = 0;                    ///< s; 0: not periodic
  std::span<const double> time;         ///< s
  std::span<const std::uint32_t> node;  ///< moving nodes
  std::span<const PoseRecord> pose;     ///< time by time, one per moving node
};

/// The record of one branch in a file.
struct BranchView {
  std::uint32_t firstNode = 0, nodeCount = 0;
  std::int32_t parentNode = -1;
  std::uint32_t labelOffset = 0;
  std::uint16_t labelSize = 0;
  std::uint8_t kind = 0, stopReason = 0;
  float meanInlierRate = kNoRate;
};

/// A case in the bytes of a file. All but the metadata is ready to use; only the list of node
/// arrays is owned. Spans of parts that the file lacks are empty.
struct CaseView {
  FormatVersion version;
  std::string_view metadata;  ///< JSON
  std::span<const Float3> nodeCentre, nodeDirection;
  std::span<const float> nodeRadius, nodeHeight, nodeInlierRate;
  std::span<const std::int32_t> nodeParent;
  std::span<const std::uint32_t> nodeBranch;
  std::span<const std::array<std::uint32_t, 2>> links;
  std::span<const std::byte> branchRecords;  ///< kBranchRecordSize each
  std::string_view branchLabels;
  bool hasPoints = false;
  std::span<const std::uint32_t> pointOffset;  ///< one per node, and one more
  std::span<const Float3> pointPosition;
  std::optional<ModelView> models;
  std::optional<MotionView> motion;
  std::vector<std::span<const std::byte>> nodeArrays;  ///< as the metadata describes them

  [[nodiscard]] std::size_t nodeCount() const { return nodeCentre.size(); }
  [[nodiscard]] std::size_t branchCount() const { return branchRecords.size() / kBranchRecordSize; }
  [[nodiscard]] BranchView branch(std::size_t index) const;
  /// The label of a branch; empty if its record names bytes that are not there.
  [[nodiscard]] std::string_view label(const BranchView& branch) const;
};

/// Extent of verification. Structure: header, table and sizes; no chunk's body is read but the 24
/// bytes of a kernel record,
/// so offsets, parents and all other values may be anything. All: checksums, padding and every rule
/// of the model too; only the metadata is not looked into (that needs a JSON reader).
enum class Verify : std::uint8_t { Structure, All };

/// The view of a file. `bytes` must start at a multiple of 8, as mapped and allocated memory does,
/// and outlive the view. A chunk that is stored encoded cannot be viewed: CHUNK_ENCODING names it.
/// Time and memory do not depend on the number of nodes for Verify::Structure.
Expected<CaseView> viewCase(std::span<const std::byte> bytes, Verify verify);

/// The motion in the decoded bytes of its chunk, which start at a multiple of 8 in memory. Reports
/// a size that is not that of its counts, and counts beyond their limits; the view is empty then.
MotionView viewMotion(const Chunk& chunk, IssueList& issues);

/// The view of chunks that hold no encoded bytes, and whose group of required ones is complete.
/// Reports sizes that do not fit, labels that do not fill their chunk, and reserved bytes; the view
/// is complete if there are none.
CaseView assembleView(const CaseChunks& chunks, Verify verify, IssueList& issues);

}  // namespace lumen::formats
