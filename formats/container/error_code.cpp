// SPDX-License-Identifier: Apache-2.0
#include "formats/container/error_code.h"

#include <array>
#include <cstddef>

namespace lumen::formats {
namespace {

using enum ErrorCode;

constexpr auto kRules = std::to_array<ErrorRule>({
    {Magic, "MAGIC", "the first ten bytes are not the signature"},
    {Truncated, "TRUNCATED",
     "the file is shorter than its header or than the length that the header states"},
    {TrailingBytes, "TRAILING_BYTES",
     "bytes follow the stated length, or the end of the last chunk"},
    {HeaderChecksum, "HEADER_CHECKSUM", "the header does not match its checksum"},
    {HeaderField, "HEADER_FIELD",
     "a header field has an illegal value, or a reserved byte is not zero"},
    {Version, "VERSION", "the file needs a newer reader, or its version is not one"},
    {ChunkCount, "CHUNK_COUNT", "the chunk table does not fit into the file, or exceeds its limit"},
    {TableChecksum, "TABLE_CHECKSUM", "the chunk table does not match its checksum"},
    {ChunkType, "CHUNK_TYPE", "a chunk type is not four ASCII letters or digits"},
    {ChunkField, "CHUNK_FIELD", "a chunk's flags are illegal, or a reserved byte is not zero"},
    {ChunkOffset, "CHUNK_OFFSET",
     "a chunk does not start at the first multiple of 64 after the one before"},
    {ChunkSize, "CHUNK_SIZE",
     "a chunk ends beyond the file, or its two sizes contradict its encoding"},
    {ChunkPadding, "CHUNK_PADDING", "a padding byte is not zero"},
    {ChunkChecksum, "CHUNK_CHECKSUM", "a chunk's bytes do not match their checksum"},
    {ChunkEncoding, "CHUNK_ENCODING",
     "a chunk that is needed has an encoding that the reader lacks"},
    {ChunkUnknown, "CHUNK_UNKNOWN", "a critical chunk has a type that the reader does not know"},
    {ChunkVersion, "CHUNK_VERSION", "a chunk has a version that the reader does not know"},
    {ChunkDuplicate, "CHUNK_DUPLICATE", "a chunk that may occur once occurs again"},
    {ChunkMissing, "CHUNK_MISSING",
     "a required chunk, or one of a group that comes together, is absent"},
    {ChunkLength, "CHUNK_LENGTH", "a chunk's size is not that of its elements"},
    {JsonSyntax, "JSON_SYNTAX", "the text is not JSON in UTF-8"},
    {JsonDepth, "JSON_DEPTH", "arrays and objects are nested too deeply"},
    {JsonDuplicateKey, "JSON_DUPLICATE_KEY", "an object has the same key twice"},
    {JsonKeyUnknown, "JSON_KEY_UNKNOWN", "an object has a key that the format does not define"},
    {JsonKeyMissing, "JSON_KEY_MISSING", "an object lacks a required key"},
    {JsonType, "JSON_TYPE", "a value has another JSON type than the format defines"},
    {NumberRange, "NUMBER_RANGE", "a number cannot be represented in the type of its field"},
    {NotLumen, "NOT_LUMEN", "the first bytes are those of neither encoding"},
    {CoordinateSystem, "COORDINATE_SYSTEM", "the coordinate system is not \"LPS\""},
    {Units, "UNITS", "the unit of length is not \"mm\""},
    {EnumValue, "ENUM_VALUE",
     "a kind, stop reason or kernel is none of those that the format defines"},
    {Limit, "LIMIT", "a count exceeds its published maximum"},
    {ArrayLength, "ARRAY_LENGTH",
     "an array has another length than the number of nodes or blobs asks for"},
    {NotFinite, "NOT_FINITE", "a number is infinite or not a number"},
    {TreeEmpty, "TREE_EMPTY", "the tree has no node"},
    {RadiusRange, "RADIUS_RANGE", "a radius is not positive"},
    {HeightRange, "HEIGHT_RANGE", "a height is negative"},
    {DirectionLength, "DIRECTION_LENGTH", "a direction is not a unit vector"},
    {InlierRateRange, "INLIER_RATE_RANGE", "an inlier rate is outside 0 to 1"},
    {NodeParent, "NODE_PARENT", "a node's parent is neither -1 nor a node before it"},
    {NodeBranch, "NODE_BRANCH", "a node names another branch than the one whose range holds it"},
    {NodeChain, "NODE_CHAIN", "a node's parent is not the node before it in its branch"},
    {BranchRange, "BRANCH_RANGE",
     "the branches' ranges are empty, or do not tile the nodes in order"},
    {BranchParent, "BRANCH_PARENT", "a branch's parent node is not the parent of its first node"},
    {LabelEmpty, "LABEL_EMPTY", "a label is empty"},
    {LabelDuplicate, "LABEL_DUPLICATE", "two branches have the same label"},
    {TextUtf8, "TEXT_UTF8", "a text is not valid UTF-8"},
    {TextControl, "TEXT_CONTROL", "a text has a control character"},
    {TextLength, "TEXT_LENGTH", "a text is empty where it must not be, or too long"},
    {OffsetStart, "OFFSET_START", "an offset array does not start at 0"},
    {OffsetOrder, "OFFSET_ORDER", "an offset array decreases"},
    {OffsetEnd, "OFFSET_END", "an offset array does not end at the number of elements"},
    {KernelParameter, "KERNEL_PARAMETER",
     "the parameter of a Cauchy or Gaussian kernel is not positive"},
    {IsoLevel, "ISO_LEVEL", "the iso-level is not positive"},
    {WidthRange, "WIDTH_RANGE", "a blob's width is not positive"},
    {VoxelSize, "VOXEL_SIZE", "the voxel size is not positive"},
    {SourceSize, "SOURCE_SIZE", "the source volume has no voxel along an axis"},
    {SourceSpacing, "SOURCE_SPACING", "the source volume's spacing is not positive"},
    {SourceDirection, "SOURCE_DIRECTION", "the source volume's axes are not orthonormal"},
    {SourceSha256, "SOURCE_SHA256",
     "the source volume's digest is not 64 lower-case hexadecimal digits"},
    {IoMissing, "IO_MISSING", "there is no such file"},
    {IoNotAFile, "IO_NOT_A_FILE", "the path leads to a directory or a device"},
    {IoEmpty, "IO_EMPTY", "the file has no bytes"},
    {IoRead, "IO_READ", "the file cannot be opened or read"},
    {IoWrite, "IO_WRITE", "the file cannot be written"},
});

constexpr bool inOrder() {
  for (std::size_t i = 0; i < kRules.size(); ++i)
    if (static_cast<std::size_t>(kRules[i].code) != i) return false;
  return true;
}
static_assert(inOrder() && kRules.size() == static_cast<std::size_t>(IoWrite) + 1);

}  // namespace

std::span<const ErrorRule> errorRules() {
  return kRules;
}

const char* errorName(ErrorCode code) {
  return kRules[static_cast<std::size_t>(code)].name;
}

}  // namespace lumen::formats
