// SPDX-License-Identifier: Apache-2.0
// The rules that the values of a case obey, whichever encoding they come from; see spec/lumen.md,
// "Rules of the model". Places are JSON pointers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "formats/view/case_view.h"

namespace lumen::formats {

inline constexpr std::uint8_t kBranchKindCount = 2;
inline constexpr std::uint8_t kStopReasonCount = 7;

/// Checks sizes, ranges, references, finiteness and labels: everything but the metadata, the node
/// arrays and the kernel records. A check that needs the result of a failed one is left out.
void checkModelRules(const CaseView& view, IssueList& issues);

/// Checks kernels, their parameters and iso-levels.
void checkKernels(const CaseView& view, IssueList& issues);

/// Fills the first three fields from a record of kKernelRecordSize.
void readKernelRecord(std::span<const std::byte> record, ModelView& model);

/// Place in the file of the value that a pointer names: its first byte, or that of its chunk if the
/// chunk is encoded or the value is inside of the metadata. Nothing if the pointer names no chunk.
std::optional<std::uint64_t> findByteOffset(const std::string& pointer, const CaseChunks& chunks);

// The parts of checkModelRules().
void checkTreeRules(const CaseView& view, IssueList& issues);
void checkBranchRules(const CaseView& view, IssueList& issues);
void checkLinkRules(const CaseView& view, IssueList& issues);
void checkMotionRules(const CaseView& view, IssueList& issues);
void checkOffsets(std::span<const std::uint32_t> offset, std::size_t nodeCount,
                  std::size_t elements, const std::string& pointer, IssueList& issues);

/// Condition on the values of an array, besides being finite.
struct ValueRule {
  bool (*legal)(float);
  ErrorCode code;
  const char* expected;
};

void checkValues(std::span<const float> values, const std::string& pointer, const ValueRule& rule,
                 IssueList& issues);
void checkFinite(double value, const std::string& pointer, IssueList& issues);
void checkPositive(double value, const std::string& pointer, ErrorCode code, IssueList& issues);
void checkFinite(std::span<const Float3> vectors, const std::string& pointer, IssueList& issues);
/// Whether both lengths are equal; adds an issue if not.
bool checkLength(std::size_t found, std::size_t expected, const std::string& pointer,
                 IssueList& issues);
bool checkLimit(std::size_t found, std::size_t limit, const std::string& pointer,
                IssueList& issues);

}  // namespace lumen::formats
