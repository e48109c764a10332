// SPDX-License-Identifier: Apache-2.0
// The numbered rules of the format: why a file or a case is refused.
#pragma once

#include <cstdint>
#include <span>

namespace lumen::formats {

/// Names and numbers outlive wording; they are stable and never used again for another rule. See
/// spec/errors.md, which is made from this list.
enum class ErrorCode : std::uint16_t {
  // the container
  Magic = 101,
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
  ChunkExpansion,
  ChunkDecode,
  // the chunks of a case
  ChunkUnknown = 201,
  ChunkVersion,
  ChunkDuplicate,
  ChunkMissing,
  ChunkLength,
  ChunkIgnored,
  ChunkOrder,
  // JSON
  JsonSyntax = 301,
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
  JsonChunkData,
  // the model
  Limit = 401,
  ArrayLength,
  NotFinite,
  NegativeZero,
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
  LinkNode,
  LinkOrder,
  LinkParent,
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
  CompactKernel,
  CompactAlone,
  // provenance and extensions
  VoxelSize = 501,
  SourceSize,
  SourceSpacing,
  SourceDirection,
  SourceSha256,
  ParentSha256,
  PointQuantisation,
  RandomSeed,
  ExtensionName,
  ExtensionDuplicate,
  ExtensionUnlisted,
  ExtensionRequired,
  NodeArrayName,
  NodeArrayComponents,
  // privacy: reported only when asked for
  PrivacyDate = 601,
  PrivacyPath,
  PrivacyAddress,
  PrivacyNumber,
  PrivacyName,
  // files
  IoMissing = 901,
  IoNotAFile,
  IoEmpty,
  IoRead,
  IoWrite,
  ViewMemory,
};

enum class Severity : std::uint8_t {
  Error,        ///< the file is refused
  Warning,      ///< legal, but not what a writer should write
  Information,  ///< legal, and worth knowing
};

struct ErrorRule {
  ErrorCode code;
  Severity severity;
  const char* name;       ///< upper case: what messages, tests and other programs use
  const char* arguments;  ///< their names, with a space between; not all need be given
  const char* meaning;    ///< one phrase
};

/// Every rule, in the order of ErrorCode.
std::span<const ErrorRule> errorRules();

const ErrorRule& errorRule(ErrorCode code);

/// The stable name, such as TRUNCATED.
const char* errorName(ErrorCode code);

Severity severityOf(ErrorCode code);

/// "error", "warning" or "information".
const char* severityName(Severity severity);

}  // namespace lumen::formats
