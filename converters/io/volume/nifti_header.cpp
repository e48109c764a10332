// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/nifti_header.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "converters/base/error.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

// Every whole number up to here is exact in the float that holds the voxels' offset; headers with
// extensions are shorter.
constexpr double kMaxOffset = 1 << 24;

constexpr const char* kWriteNifti1 = ", as 3D Slicer and nibabel's nib-convert write it";

/// A type of one number for each voxel.
struct ScalarType {
  int code;
  PixelType type;
};
constexpr std::array<ScalarType, 10> kScalarTypes = {{{2, PixelType::UInt8},
                                                      {4, PixelType::Int16},
                                                      {8, PixelType::Int32},
                                                      {16, PixelType::Float32},
                                                      {64, PixelType::Float64},
                                                      {256, PixelType::Int8},
                                                      {512, PixelType::UInt16},
                                                      {768, PixelType::UInt32},
                                                      {1024, PixelType::Int64},
                                                      {1280, PixelType::UInt64}}};

/// Types of several numbers for each voxel.
struct CompoundType {
  int code;
  const char* components;
};
constexpr std::array<CompoundType, 5> kCompoundTypes = {{{32, "2 components (complex)"},
                                                         {128, "3 components (rgb)"},
                                                         {1792, "2 components (complex)"},
                                                         {2048, "2 components (complex)"},
                                                         {2304, "4 components (rgba)"}}};

/// Fields of a header in either byte order, by their place.
class Fields {
public:
  Fields(std::span<const std::byte, kNiftiHeaderSize> bytes, bool swapped)
      : m_bytes(bytes), m_swapped(swapped) {}

  template <class T>
  [[nodiscard]] T get(std::size_t at) const {
    std::array<std::byte, sizeof(T)> raw{};
    std::copy_n(m_bytes.begin() + static_cast<std::ptrdiff_t>(at), sizeof(T), raw.begin());
    if (m_swapped) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  [[nodiscard]] int get16(std::size_t at) const { return get<std::int16_t>(at); }

  template <std::size_t N>
  [[nodiscard]] std::array<float, N> floats(std::size_t at) const {
    std::array<float, N> values{};
    for (std::size_t i = 0; i < N; ++i) values[i] = get<float>(at + 4 * i);
    return values;
  }

private:
  std::span<const std::byte, kNiftiHeaderSize> m_bytes;
  bool m_swapped;
};

[[noreturn]] void refuse(const fs::path& path, const std::string& found,
                         const std::string& expected) {
  throw invalidInput(path.string() + ": " + found + "; expected " + expected);
}

/// True if the bytes are swapped: the header's size, its first field, is 348 in the right byte
/// order.
bool isSwapped(std::span<const std::byte, kNiftiHeaderSize> bytes, const fs::path& path) {
  constexpr std::int32_t kSize = kNiftiHeaderSize, kSizeOfNifti2 = 540;
  for (const bool swapped : {false, true}) {
    const auto size = Fields(bytes, swapped).get<std::int32_t>(0);
    if (size == kSizeOfNifti2)
      throw unsupported(path.string() + ": is NIfTI-2; expected NIfTI-1" + kWriteNifti1);
    if (size == kSize) return swapped;
  }
  refuse(path, "is not a NIfTI file: its first number, the header's size, is not 348",
         "a NIfTI-1 header");
}

void checkMagic(std::span<const std::byte, kNiftiHeaderSize> bytes, const fs::path& path) {
  const auto is = [&](const char* magic) { return std::memcmp(&bytes[344], magic, 4) == 0; };
  if (is("n+1")) return;
  if (is("ni1"))
    throw unsupported(path.string() +
                      ": is the header of a pair of files (.hdr and .img); expected one file with "
                      "header and voxels, .nii or .nii.gz" +
                      kWriteNifti1);
  refuse(path, "is not a NIfTI file: the magic \"n+1\" at byte 344 is missing",
         std::string("NIfTI-1 rather than, for instance, ANALYZE 7.5") + kWriteNifti1);
}

/// Reads dim: at least three axes, and at least one voxel along each.
void readSizes(const Fields& fields, NiftiHeader& header, const fs::path& path) {
  const int dimensions = fields.get16(40);
  if (dimensions < 1 || dimensions > 7)
    refuse(path, "dim[0], the number of dimensions, is " + std::to_string(dimensions), "3");
  for (int a = 1; a <= dimensions; ++a) {
    const int count = fields.get16(40 + 2 * static_cast<std::size_t>(a));
    if (count < 1)
      refuse(path, "dim[" + std::to_string(a) + "] is " + std::to_string(count),
             "a positive count of voxels");
    if (a <= 3)
      header.size[static_cast<std::size_t>(a) - 1] = count;
    else
      header.volumes *= static_cast<std::uint64_t>(count);
    header.sizes += (a > 1 ? " x " : "") + std::to_string(count);
  }
  if (dimensions < 3) refuseDimensions(path, static_cast<unsigned>(dimensions), header.sizes);
  constexpr double kMostVoxels = 1e15;  // beyond any file, and far below overflow
  if (static_cast<double>(header.volumes) * static_cast<double>(header.voxelCount()) > kMostVoxels)
    refuse(path, "dim announces " + header.sizes + " voxels", "as many as a file can hold");
}

PixelType typeOf(const Fields& fields, const fs::path& path) {
  const int code = fields.get16(70), bits = fields.get16(72);
  for (const CompoundType& type : kCompoundTypes)
    if (type.code == code)
      refuse(path, std::string("each voxel has ") + type.components, "one number");
  const auto* const type = std::find_if(kScalarTypes.begin(), kScalarTypes.end(),
                                        [&](const ScalarType& t) { return t.code == code; });
  if (type == kScalarTypes.end())
    throw unsupported(path.string() + ": its NIfTI datatype is " + std::to_string(code) +
                      "; expected integers of 8 to 64 bits, floats or doubles");
  const std::size_t expected = 8 * sizeOf(type->type);
  if (bits != static_cast<int>(expected))
    refuse(path,
           "bitpix is " + std::to_string(bits) + ", but datatype is " + std::to_string(code) +
               " (" + nameOf(type->type) + ")",
           std::to_string(expected) + " bits");
  return type->type;
}

std::size_t offsetOf(const Fields& fields, const fs::path& path) {
  const auto offset = static_cast<double>(fields.get<float>(108));
  if (offset >= kNiftiFirstVoxel && offset <= kMaxOffset && offset == std::floor(offset))
    return static_cast<std::size_t>(offset);
  const bool inside = offset >= 0 && offset < kNiftiFirstVoxel;
  refuse(path,
         "vox_offset is " + longNumber(offset) +
             (inside ? ", so the header itself would be read as voxels" : ""),
         "a whole number from 352 to " + longNumber(kMaxOffset));
}

void readScaling(const Fields& fields, NiftiHeader& header, const fs::path& path) {
  header.slope = fields.get<float>(112);
  header.intercept = fields.get<float>(116);
  header.isSlopeMissing = std::isnan(header.slope);
  if (header.isSlopeMissing) header.slope = header.intercept = 0;
  if (!std::isfinite(header.slope))
    refuse(path, "scl_slope is " + longNumber(static_cast<double>(header.slope)),
           "a number, 0 where values are not scaled");
  if (header.slope != 0 && !std::isfinite(header.intercept))
    refuse(path, "scl_inter is " + longNumber(static_cast<double>(header.intercept)),
           "a number, 0 where values are not shifted");
}

}  // namespace

void checkNiftiStart(std::span<const std::byte, kNiftiHeaderSize> bytes, const fs::path& path) {
  (void)isSwapped(bytes, path);
}

NiftiHeader parseNiftiHeader(std::span<const std::byte, kNiftiHeaderSize> bytes,
                             const fs::path& path) {
  NiftiHeader header;
  header.swapped = isSwapped(bytes, path);
  checkMagic(bytes, path);
  const Fields fields(bytes, header.swapped);
  header.type = typeOf(fields, path);
  readSizes(fields, header, path);
  header.voxelOffset = offsetOf(fields, path);
  readScaling(fields, header, path);
  header.handedness = fields.get<float>(76);
  header.pixdim = fields.floats<3>(80);
  constexpr int kSpaceBits = 7;
  header.unitCode = std::to_integer<int>(bytes[123]) & kSpaceBits;
  header.qformCode = fields.get16(252);
  header.sformCode = fields.get16(254);
  header.quaternion = fields.floats<3>(256);
  header.qOffset = fields.floats<3>(268);
  for (std::size_t r = 0; r < 3; ++r) header.sform[r] = fields.floats<4>(280 + 16 * r);
  return header;
}

}  // namespace lumen::convert
