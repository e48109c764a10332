// SPDX-License-Identifier: Apache-2.0
#include "formats/container/error_code.h"

#include <algorithm>
#include <array>

namespace lumen::formats {
namespace rules {  // in which the names of codes stand alone

using enum ErrorCode;

constexpr auto kRules = std::to_array<ErrorRule>({
    {Magic, Severity::Error, "MAGIC", "", "the first ten bytes are not the signature"},
    {Truncated, Severity::Error, "TRUNCATED", "found expected",
     "the file is shorter than its header or than the length that the header states"},
    {TrailingBytes, Severity::Error, "TRAILING_BYTES", "found expected",
     "bytes follow the stated length, or the end of the last chunk"},
    {HeaderChecksum, Severity::Error, "HEADER_CHECKSUM", "found expected",
     "the header does not match its checksum"},
    {HeaderField, Severity::Error, "HEADER_FIELD", "found expected",
     "a header field has an illegal value, or a reserved byte is not zero"},
    {Version, Severity::Error, "VERSION", "found expected",
     "the file needs a newer reader, or its version is not one"},
    {ChunkCount, Severity::Error, "CHUNK_COUNT", "found limit",
     "the chunk table does not fit into the file, or exceeds its limit"},
    {TableChecksum, Severity::Error, "TABLE_CHECKSUM", "found expected",
     "the chunk table does not match its checksum"},
    {ChunkType, Severity::Error, "CHUNK_TYPE", "found",
     "a chunk type is not four ASCII letters or digits"},
    {ChunkField, Severity::Error, "CHUNK_FIELD", "chunk",
     "a chunk's flags are illegal, or a reserved byte is not zero"},
    {ChunkOffset, Severity::Error, "CHUNK_OFFSET", "chunk found expected",
     "a chunk does not start at the first multiple of 64 after the one before"},
    {ChunkSize, Severity::Error, "CHUNK_SIZE", "chunk found expected",
     "a chunk ends beyond the file, or its two sizes contradict its encoding"},
    {ChunkPadding, Severity::Error, "CHUNK_PADDING", "found", "a padding byte is not zero"},
    {ChunkChecksum, Severity::Error, "CHUNK_CHECKSUM", "chunk found expected",
     "a chunk's bytes do not match their checksum"},
    {ChunkEncoding, Severity::Error, "CHUNK_ENCODING", "chunk found",
     "a chunk has an encoding that its type or the reader does not have"},
    {ChunkExpansion, Severity::Error, "CHUNK_EXPANSION", "chunk found limit",
     "the raw size of an encoded chunk is beyond 256 times its stored size"},
    {ChunkDecode, Severity::Error, "CHUNK_DECODE", "chunk",
     "an encoded chunk does not decode to its raw size"},
    {ChunkUnknown, Severity::Error, "CHUNK_UNKNOWN", "chunk",
     "a critical chunk has a type that the reader does not know"},
    {ChunkVersion, Severity::Error, "CHUNK_VERSION", "chunk found",
     "a chunk has a version that the reader does not know"},
    {ChunkDuplicate, Severity::Error, "CHUNK_DUPLICATE", "chunk",
     "a chunk that may occur once occurs again"},
    {ChunkMissing, Severity::Error, "CHUNK_MISSING", "chunk",
     "a required chunk, or one of a group that comes together, is absent"},
    {ChunkLength, Severity::Error, "CHUNK_LENGTH", "chunk found expected",
     "a chunk's size is not that of its elements"},
    {ChunkIgnored, Severity::Information, "CHUNK_IGNORED", "chunk",
     "a chunk that is not critical has a type that the reader does not know"},
    {ChunkOrder, Severity::Warning, "CHUNK_ORDER", "chunk",
     "a chunk comes before one that should precede it"},
    {JsonSyntax, Severity::Error, "JSON_SYNTAX", "", "the text is not JSON in UTF-8"},
    {JsonDepth, Severity::Error, "JSON_DEPTH", "limit", "arrays and objects are nested too deeply"},
    {JsonDuplicateKey, Severity::Error, "JSON_DUPLICATE_KEY", "key",
     "an object has the same key twice"},
    {JsonKeyUnknown, Severity::Error, "JSON_KEY_UNKNOWN", "key",
     "an object has a key that the format does not define"},
    {JsonKeyMissing, Severity::Error, "JSON_KEY_MISSING", "key", "an object lacks a required key"},
    {JsonType, Severity::Error, "JSON_TYPE", "found expected",
     "a value has another JSON type than the format defines"},
    {NumberRange, Severity::Error, "NUMBER_RANGE", "found",
     "a number cannot be represented in the type of its field"},
    {NotLumen, Severity::Error, "NOT_LUMEN", "found expected", "the file is in neither encoding"},
    {CoordinateSystem, Severity::Error, "COORDINATE_SYSTEM", "found expected",
     "the coordinate system is not \"LPS\""},
    {Units, Severity::Error, "UNITS", "found expected", "the unit of length is not \"mm\""},
    {EnumValue, Severity::Error, "ENUM_VALUE", "found expected",
     "a kind, stop reason, kernel or array type is none of those that the format defines"},
    {JsonChunkData, Severity::Error, "JSON_CHUNK_DATA", "chunk",
     "the data of a chunk in JSON are not base64, its type is that of a known chunk, or its raw "
     "size "
     "is missing, not wanted or too large"},
    {Limit, Severity::Error, "LIMIT", "found limit", "a count exceeds its published maximum"},
    {ArrayLength, Severity::Error, "ARRAY_LENGTH", "found expected",
     "an array has another length than the number of nodes or blobs asks for"},
    {NotFinite, Severity::Error, "NOT_FINITE", "found expected",
     "a number is infinite or not a number"},
    {NegativeZero, Severity::Warning, "NEGATIVE_ZERO", "", "a number is a negative zero"},
    {TreeEmpty, Severity::Error, "TREE_EMPTY", "", "the tree has no node"},
    {RadiusRange, Severity::Error, "RADIUS_RANGE", "found expected", "a radius is not positive"},
    {HeightRange, Severity::Error, "HEIGHT_RANGE", "found expected", "a height is negative"},
    {DirectionLength, Severity::Error, "DIRECTION_LENGTH", "found expected",
     "a direction is not a unit vector"},
    {InlierRateRange, Severity::Error, "INLIER_RATE_RANGE", "found expected",
     "an inlier rate is outside 0 to 1"},
    {NodeParent, Severity::Error, "NODE_PARENT", "found limit",
     "a node's parent is neither -1 nor a node before it"},
    {NodeBranch, Severity::Error, "NODE_BRANCH", "found expected",
     "a node names another branch than the one whose range holds it"},
    {NodeChain, Severity::Error, "NODE_CHAIN", "found expected",
     "a node's parent is not the node before it in its branch"},
    {BranchRange, Severity::Error, "BRANCH_RANGE", "found expected",
     "the branches' ranges are empty, or do not tile the nodes in order"},
    {BranchParent, Severity::Error, "BRANCH_PARENT", "found expected",
     "a branch's parent node is not the parent of its first node"},
    {LinkNode, Severity::Error, "LINK_NODE", "found limit",
     "a link names a node that does not exist"},
    {LinkOrder, Severity::Error, "LINK_ORDER", "",
     "a link's nodes do not ascend, or the links do not"},
    {LinkParent, Severity::Error, "LINK_PARENT", "", "a link joins a node and its parent"},
    {LabelEmpty, Severity::Error, "LABEL_EMPTY", "", "a label is empty"},
    {LabelDuplicate, Severity::Error, "LABEL_DUPLICATE", "found",
     "two branches have the same label"},
    {TextUtf8, Severity::Error, "TEXT_UTF8", "found", "a text is not valid UTF-8"},
    {TextControl, Severity::Error, "TEXT_CONTROL", "found", "a text has a control character"},
    {TextLength, Severity::Error, "TEXT_LENGTH", "found limit",
     "a text is empty where it must not be, or too long"},
    {OffsetStart, Severity::Error, "OFFSET_START", "found expected",
     "an offset array does not start at 0"},
    {OffsetOrder, Severity::Error, "OFFSET_ORDER", "found expected", "an offset array decreases"},
    {OffsetEnd, Severity::Error, "OFFSET_END", "found expected",
     "an offset array does not end at the number of elements"},
    {KernelParameter, Severity::Error, "KERNEL_PARAMETER", "found expected",
     "the parameter of a Cauchy or Gaussian kernel is not positive"},
    {IsoLevel, Severity::Error, "ISO_LEVEL", "found expected", "the iso-level is not positive"},
    {WidthRange, Severity::Error, "WIDTH_RANGE", "found expected",
     "a blob's width is not positive"},
    {LabelOffset, Severity::Error, "LABEL_OFFSET", "found expected",
     "a label does not start where the one before it ends"},
    {MotionTime, Severity::Error, "MOTION_TIME", "found expected",
     "a motion has no time, or its times do not ascend"},
    {MotionPeriod, Severity::Error, "MOTION_PERIOD", "found expected",
     "the period of a motion is not longer than from its first time to its last"},
    {MotionNode, Severity::Error, "MOTION_NODE", "found expected",
     "a moving node does not exist, or the moving nodes do not ascend"},
    {MotionRotation, Severity::Error, "MOTION_ROTATION", "found expected",
     "a rotation is not a unit quaternion"},
    {MotionFactor, Severity::Error, "MOTION_FACTOR", "found expected",
     "the factor of a pose is not positive"},
    {VoxelSize, Severity::Error, "VOXEL_SIZE", "found expected", "the voxel size is not positive"},
    {SourceSize, Severity::Error, "SOURCE_SIZE", "",
     "the source volume has no voxel along an axis"},
    {SourceSpacing, Severity::Error, "SOURCE_SPACING", "found expected",
     "the source volume's spacing is not positive"},
    {SourceDirection, Severity::Error, "SOURCE_DIRECTION", "found expected",
     "the source volume's axes are not orthonormal"},
    {SourceSha256, Severity::Error, "SOURCE_SHA256", "",
     "the source volume's digest is not 64 lower-case hexadecimal digits"},
    {ParentSha256, Severity::Error, "PARENT_SHA256", "",
     "the parent file's digest is not 64 lower-case hexadecimal digits"},
    {PointQuantisation, Severity::Error, "POINT_QUANTISATION", "found expected",
     "the bits of the point quantisation are not 1 to 30, or its step is not positive"},
    {RandomSeed, Severity::Error, "RANDOM_SEED", "found expected",
     "the parameter random-seed is not an integer from 0"},
    {ExtensionName, Severity::Error, "EXTENSION_NAME", "found",
     "an extension's name is not VENDOR_name"},
    {ExtensionDuplicate, Severity::Error, "EXTENSION_DUPLICATE", "found",
     "an extension is listed twice"},
    {ExtensionUnlisted, Severity::Error, "EXTENSION_UNLISTED", "found",
     "an extension is required, or has an array, and is not listed as used"},
    {ExtensionRequired, Severity::Error, "EXTENSION_REQUIRED", "found",
     "the file requires an extension that the reader does not have"},
    {NodeArrayName, Severity::Error, "NODE_ARRAY_NAME", "found",
     "a node array's name is not EXTENSION.name, or occurs twice"},
    {NodeArrayComponents, Severity::Error, "NODE_ARRAY_COMPONENTS", "found limit",
     "the number of components of a node array is not 1 to 16"},
    {IoMissing, Severity::Error, "IO_MISSING", "", "there is no such file"},
    {IoNotAFile, Severity::Error, "IO_NOT_A_FILE", "", "the path leads to a directory or a device"},
    {IoEmpty, Severity::Error, "IO_EMPTY", "", "the file has no bytes"},
    {IoRead, Severity::Error, "IO_READ", "", "the file cannot be opened or read"},
    {IoWrite, Severity::Error, "IO_WRITE", "", "the file cannot be written"},
    {ViewMemory, Severity::Error, "VIEW_MEMORY", "",
     "the bytes cannot be used in place: they are not aligned, or the machine is big-endian"},
});

constexpr bool ascending() {
  for (std::size_t i = 1; i < kRules.size(); ++i)
    if (kRules[i].code <= kRules[i - 1].code) return false;
  return true;
}
static_assert(ascending());

}  // namespace rules

std::span<const ErrorRule> errorRules() {
  return rules::kRules;
}

const ErrorRule& errorRule(ErrorCode code) {
  return *std::lower_bound(rules::kRules.begin(), rules::kRules.end(), code,
                           [](const ErrorRule& rule, ErrorCode c) { return rule.code < c; });
}

const char* errorName(ErrorCode code) {
  return errorRule(code).name;
}

Severity severityOf(ErrorCode code) {
  return errorRule(code).severity;
}

const char* severityName(Severity severity) {
  switch (severity) {
    case Severity::Error:
      return "error";
    case Severity::Warning:
      return "warning";
    case Severity::Information:
      break;
  }
  return "information";
}

}  // namespace lumen::formats
