// SPDX-License-Identifier: Apache-2.0
// The numbered rules of the format: why a file or a case is refused.
#pragma once

#include <cstdint>
#include <span>

namespace lumen::formats {

/// Append only: names outlive wording and are never reused. See spec/lumen.md, "Errors".
enum class ErrorCode : std::uint8_t {
  // the container
  Magic,
  Truncated,
  TrailingBytes,
  HeaderChecksum,
  HeaderField,
  Version,
  ChunkCount,
  TableChecksum,
  ChunkType,
  ChunkField,
  ChunkOffset,
  ChunkSize,
  ChunkPadding,
  ChunkChecksum,
  ChunkEncoding,
  // the chunks of a case
  ChunkUnknown,
  ChunkVersion,
  ChunkDuplicate,
  ChunkMissing,
  ChunkLength,
  // JSON
  JsonSyntax,
  JsonDepth,
  JsonDuplicateKey,
  JsonKeyUnknown,
  JsonKeyMissing,
  JsonType,
  NumberRange,
  NotLumen,
  CoordinateSystem,
  Units,
  EnumValue,
  // the model
  Limit,
  ArrayLength,
  NotFinite,
  TreeEmpty,
  RadiusRange,
  HeightRange,
  DirectionLength,
  InlierRateRange,
  NodeParent,
  NodeBranch,
  NodeChain,
  BranchRange,
  BranchParent,
  LabelEmpty,
  LabelDuplicate,
  TextUtf8,
  TextControl,
  TextLength,
  OffsetStart,
  OffsetOrder,
  OffsetEnd,
  KernelParameter,
  IsoLevel,
  WidthRange,
  VoxelSize,
  SourceSize,
  SourceSpacing,
  SourceDirection,
  SourceSha256,
  // files
  IoMissing,
  IoNotAFile,
  IoEmpty,
  IoRead,
  IoWrite,
};

struct ErrorRule {
  ErrorCode code;
  const char* name;     ///< stable, upper case: what messages, tests and other programs use
  const char* meaning;  ///< one phrase for the specification's table
};

/// Every rule, in the order of ErrorCode.
std::span<const ErrorRule> errorRules();

/// The stable name, such as TRUNCATED.
const char* errorName(ErrorCode code);

}  // namespace lumen::formats
