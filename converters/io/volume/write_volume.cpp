// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/write_volume.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <new>
#include <span>

#include <zlib.h>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/sha256.h"
#include "converters/io/volume/image_header.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "files have this machine's byte order");

// zlib's words for its own stream, and for one of gzip
enum class Stream { Zlib = MAX_WBITS, Gzip = MAX_WBITS + 16 };

// zlib's usual level takes four times as long on a noisy volume and saves 2 % of its size.
constexpr int kFast = 2;

/// `parts`, one after another, as one compressed stream.
std::string deflated(std::initializer_list<std::string_view> parts, Stream kind, int level) {
  constexpr std::size_t kBlock = 1 << 18;
  z_stream stream{};
  if (deflateInit2(&stream, level, Z_DEFLATED, static_cast<int>(kind), MAX_MEM_LEVEL,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, deflateEnd);
  std::string out;
  std::array<char, kBlock> block{};
  const auto run = [&](std::string_view in, int flush) {
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in.data()));
    stream.avail_in = static_cast<uInt>(in.size());
    do {
      stream.next_out = reinterpret_cast<Bytef*>(block.data());
      stream.avail_out = kBlock;
      deflate(&stream, flush);
      out.append(block.data(), kBlock - stream.avail_out);
    } while (stream.avail_out == 0);
  };
  for (const std::string_view part : parts)
    for (std::size_t at = 0; at < part.size(); at += kBlock)
      run(part.substr(at, kBlock), Z_NO_FLUSH);
  run({}, Z_FINISH);
  return out;
}

/// The numbers with `between` between them, as they read back exactly.
std::string exactTexts(const Eigen::Vector3d& v, const std::string& between) {
  return exactText(v[0]) + between + exactText(v[1]) + between + exactText(v[2]);
}

/// A key or text of NRRD's in one line.
std::string noteText(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\n' ? "\\n" : c == '\\' ? "\\\\" : std::string(1, c);
  return out;
}

/// The header of a MetaImage file; `packed` is the line about compression.
std::string metaHeader(const Volume& volume, const std::string& packed, const std::string& data) {
  constexpr std::array kTypes = {"MET_UCHAR", "MET_SHORT", "MET_USHORT", "MET_FLOAT"};
  const VolumeGeometry& g = volume.geometry;
  std::string matrix;
  for (Eigen::Index a = 0; a < 3; ++a) matrix += " " + exactTexts(g.direction.col(a), " ");
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n" +
         packed + "TransformMatrix =" + matrix + "\nOffset = " + exactTexts(g.origin, " ") +
         "\nCenterOfRotation = 0 0 0\nElementSpacing = " + exactTexts(g.spacing, " ") +
         "\nDimSize = " + joinedNumbers(g.size, " ") +
         "\nElementType = " + kTypes.at(volume.voxels.index()) + "\nElementDataFile = " + data +
         "\n";
}

}  // namespace

std::string encodeAsMetaImage(const Volume& volume, bool compressed, const fs::path& /*file*/,
                              const VolumeNotes& /*notes*/) {
  if (!compressed) return metaImageHeader(volume, "LOCAL").append(voxelBytes(volume));
  const std::string bytes = deflated({voxelBytes(volume)}, Stream::Zlib, kFast);
  return metaHeader(
             volume,
             "CompressedData = True\nCompressedDataSize = " + std::to_string(bytes.size()) + "\n",
             "LOCAL") +
         bytes;
}

std::string encodeAsNifti(const Volume& volume, bool compressed, const fs::path& file,
                          const VolumeNotes& /*notes*/) {
  const std::string header = niftiHeader(volume, file);
  if (compressed)
    return deflated({header, voxelBytes(volume)}, Stream::Gzip, Z_DEFAULT_COMPRESSION);
  return header + std::string(voxelBytes(volume));
}

std::string nrrdHeader(const NrrdVoxels& voxels, std::string_view encoding,
                       const VolumeNotes& notes) {
  const VolumeGeometry& g = voxels.geometry;
  std::string header =
      "NRRD0004\n# Complete NRRD file format specification at:\n"
      "# http://teem.sourceforge.net/nrrd/format.html\ntype: ";
  header.append(voxels.type).append("\ndimension: 3\nspace: ").append(voxels.space);
  header += "\nsizes: " + joinedNumbers(g.size, " ") + "\nspace directions:";
  for (Eigen::Index a = 0; a < 3; ++a)
    header += " (" + exactTexts(g.direction.col(a) * g.spacing[a], ",") + ")";
  header += "\nkinds: domain domain domain\n";
  if (!voxels.type.ends_with("char")) header += "endian: little\n";
  header.append("encoding: ").append(encoding) += '\n';
  if (!voxels.unit.empty()) {
    const std::string unit = " \"" + std::string(voxels.unit) + "\"";
    header += "space units:" + unit + unit + unit + "\n";
  }
  header += "space origin: (" + exactTexts(g.origin, ",") + ")\n";
  for (const auto& [key, text] : notes) header += noteText(key) + ":=" + noteText(text) + "\n";
  return header + "\n";
}

std::string encodeNrrd(const NrrdVoxels& voxels, std::string_view bytes, bool compressed,
                       const VolumeNotes& notes) {
  if (!compressed) return nrrdHeader(voxels, "raw", notes).append(bytes);
  return nrrdHeader(voxels, "gzip", notes) + deflated({bytes}, Stream::Gzip, kFast);
}

std::string encodeAsNrrd(const Volume& volume, bool compressed, const fs::path& /*file*/,
                         const VolumeNotes& notes) {
  constexpr std::array kNrrdTypes = {"unsigned char", "short", "unsigned short", "float"};
  return encodeNrrd({kNrrdTypes.at(volume.voxels.index()), volume.geometry}, voxelBytes(volume),
                    compressed, notes);
}

std::string encodeVolume(const Volume& volume, const VolumeFormat& format, bool compressed,
                         const fs::path& file, const VolumeNotes& notes) {
  if (format.encode == nullptr)
    throw unsupported(file.string() + ": this format of volumes is not written");
  return format.encode(volume, compressed, file, notes);
}

std::string metaImageHeader(const Volume& volume, const std::string& raw) {
  return metaHeader(volume, "CompressedData = False\n", raw);
}

std::string_view voxelBytes(const Volume& volume) {
  return std::visit(
      [](const auto& voxels) {
        return std::string_view(reinterpret_cast<const char*>(voxels.data()),
                                voxels.size() * sizeof(voxels[0]));
      },
      volume.voxels);
}

formats::SourceVolume describeGeometry(const VolumeGeometry& g) {
  formats::SourceVolume source;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto e = static_cast<Eigen::Index>(a);
    source.size[a] = static_cast<std::uint32_t>(g.size[a]);
    source.spacing[a] = g.spacing[e];
    source.origin[a] = g.origin[e];
    for (std::size_t c = 0; c < 3; ++c)
      source.direction[3 * a + c] = g.direction(e, static_cast<Eigen::Index>(c));
  }
  return source;
}

formats::SourceVolume describeSource(const Volume& volume) {
  formats::SourceVolume source = describeGeometry(volume.geometry);
  source.sha256 = sha256(std::as_bytes(std::span(voxelBytes(volume))));
  return source;
}

}  // namespace lumen::convert
