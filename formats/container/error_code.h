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
  Truncated = 102,
  TrailingBytes = 103,
  HeaderChecksum = 104,
  HeaderField = 105,
  Version = 106,
  ChunkCount = 107,
  TableChecksum = 108,
  ChunkType = 109,
  ChunkField = 110,
  ChunkOffset = 111,
  ChunkSize = 112,
  ChunkPadding = 113,
  ChunkChecksum = 114,
  ChunkEncoding = 115,
  ChunkExpansion = 116,
  ChunkDecode = 117,
  // the chunks of a case
  ChunkUnknown = 201,
  ChunkVersion = 202,
  ChunkDuplicate = 203,
  ChunkMissing = 204,
  ChunkLength = 205,
  ChunkIgnored = 206,
  ChunkOrder = 207,
  // JSON
  JsonSyntax = 301,
  JsonDepth = 302,
  JsonDuplicateKey = 303,
  JsonKeyUnknown = 304,
  JsonKeyMissing = 305,
  JsonType = 306,
  NumberRange = 307,
  NotLumen = 308,
  CoordinateSystem = 309,
  Units = 310,
  EnumValue = 311,
  JsonChunkData = 312,
  // the model
  Limit = 401,
  ArrayLength = 402,
  NotFinite = 403,
  NegativeZero = 404,
  TreeEmpty = 405,
  RadiusRange = 406,
  HeightRange = 407,
  DirectionLength = 408,
  InlierRateRange = 409,
  NodeParent = 410,
  NodeBranch = 411,
  NodeChain = 412,
  BranchRange = 413,
  BranchParent = 414,
  LinkNode = 415,
  LinkOrder = 416,
  LinkParent = 417,
  LabelEmpty = 418,
  LabelDuplicate = 419,
  TextUtf8 = 420,
  TextControl = 421,
  TextLength = 422,
  OffsetStart = 423,
  OffsetOrder = 424,
  OffsetEnd = 425,
  KernelParameter = 426,
  IsoLevel = 427,
  WidthRange = 428,
  LabelOffset = 431,
  MotionTime = 432,
  MotionPeriod = 433,
  MotionNode = 434,
  MotionRotation = 435,
  MotionFactor = 436,
  // provenance and extensions
  VoxelSize = 501,
  SourceSize = 502,
  SourceSpacing = 503,
  SourceDirection = 504,
  SourceSha256 = 505,
  ParentSha256 = 506,
  PointQuantisation = 507,
  RandomSeed = 508,
  ExtensionName = 509,
  ExtensionDuplicate = 510,
  ExtensionUnlisted = 511,
  ExtensionRequired = 512,
  NodeArrayName = 513,
  NodeArrayComponents = 514,
  // 601 to 700 are for programs' own findings, which are no rules of the format (spec/errors.md)
  // files
  IoMissing = 901,
  IoNotAFile = 902,
  IoEmpty = 903,
  IoRead = 904,
  IoWrite = 905,
  ViewMemory = 906,
};

enum class Severity : std::uint8_t {
  Error,        ///< the file is refused
  Warning,      ///< legal, but not what a writer should write
  Information,  ///< legal, and worth knowing
};

struct ErrorRule {
  ErrorCode code;
  Severity severity;
  const char* name;       ///< upper case; used by messages, tests and other programs
  const char* arguments;  ///< names of arguments, separated by spaces; some may be absent
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
