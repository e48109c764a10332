// SPDX-License-Identifier: Apache-2.0
#include "converters/volume/nifti_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nifti/nifti1_io.h>
#include <zlib.h>

#include "converters/common/error.h"
#include "converters/volume/nifti_geometry.h"
#include "converters/volume/volume_checks.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunk = 16 << 20;
static_assert(sizeof(nifti_1_header) == 348);

/// zlib reads plain files through the same functions.
using GzFile = std::unique_ptr<gzFile_s, int (*)(gzFile)>;

struct Header {
  nifti_1_header fields{};  ///< in this machine's byte order
  bool swapped = false;     ///< the file has the other one
};

GzFile openFile(const fs::path& path) {
  GzFile file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw invalidInput(path.string() + ": cannot be opened");
  gzbuffer(file.get(), 1 << 18);
  return file;
}

Header readHeader(gzFile file, const fs::path& path) {
  Header header;
  nifti_1_header& h = header.fields;
  const int got = gzread(file, &h, sizeof(h));
  if (got != static_cast<int>(sizeof(h)))
    throw invalidInput(path.string() + ": truncated: " + std::to_string(std::max(got, 0)) +
                       " bytes can be read, but a NIfTI header has 348");
  header.swapped = h.sizeof_hdr != 348 && h.sizeof_hdr != 540;
  if (header.swapped) swap_nifti_header(&h, 1);
  if (h.sizeof_hdr == 540) throw unsupported(path.string() + ": is NIfTI-2; expected NIfTI-1");
  if (h.sizeof_hdr != 348)
    throw invalidInput(path.string() + ": is not a NIfTI file: its header size is not 348");
  if (std::memcmp(h.magic, "n+1", 4) != 0)
    throw invalidInput(path.string() +
                       ": is not a NIfTI file with its voxels inside: the magic "
                       "\"n+1\" is missing");
  return header;
}

void checkType(int type, const fs::path& path) {
  const auto refuse = [&](const char* count, const char* kind) {
    throw invalidInput(path.string() + ": each voxel has " + count + " components (" + kind +
                       "); expected one number");
  };
  if (type == DT_RGB24) refuse("3", "rgb");
  if (type == DT_RGBA32) refuse("4", "rgba");
  if (type == DT_COMPLEX64 || type == DT_COMPLEX128 || type == DT_COMPLEX256)
    refuse("2", "complex");
}

/// Sizes: at least one voxel along each axis, and three axes of more.
void checkSizes(const nifti_1_header& h, const fs::path& path) {
  const int dimensions = h.dim[0];
  if (dimensions < 1 || dimensions > 7)
    throw invalidInput(path.string() + ": dim[0] is " + std::to_string(dimensions) +
                       "; expected 3");
  std::string sizes;
  bool flat = dimensions < 3;
  for (int a = 1; a <= dimensions; ++a) {
    if (h.dim[a] < 1)
      throw invalidInput(path.string() + ": dim[" + std::to_string(a) + "] is " +
                         std::to_string(h.dim[a]) + "; expected a positive count of voxels");
    if (a <= 3) checkStatedSpacing(path, "pixdim", a, static_cast<double>(h.pixdim[a]));
    flat = flat || (a > 3 && h.dim[a] != 1);
    sizes += (a > 1 ? " x " : "") + std::to_string(h.dim[a]);
  }
  if (flat) refuseDimensions(path, static_cast<unsigned>(dimensions), sizes);
}

void checkFileHolds(const nifti_1_header& h, bool compressed, const fs::path& path) {
  const double offset = static_cast<double>(h.vox_offset);
  if (!(offset >= 0 && offset < 0x1p31))
    throw invalidInput(path.string() + ": its vox_offset is " + std::to_string(offset) +
                       "; expected 352");
  int voxelBytes = 0, swapSize = 0;
  nifti_datatype_sizes(h.datatype, &voxelBytes, &swapSize);
  double needed = voxelBytes;
  for (int a = 1; a <= h.dim[0]; ++a) needed *= h.dim[a];
  const double room = static_cast<double>(fs::file_size(path)) - (compressed ? 0 : offset);
  checkRoom(path, needed, room, compressed);
}

class VoxelReader {
public:
  VoxelReader(gzFile file, const Header& header, std::size_t count, const fs::path& path,
              const Progress& progress)
      : m_file(file), m_header(header), m_count(count), m_path(path), m_progress(progress) {}

  Voxels read() {
    switch (m_header.fields.datatype) {
      case DT_UINT8:
        return readAs<std::uint8_t, std::uint8_t>();
      case DT_INT16:
        return readAs<std::int16_t, std::int16_t>();
      case DT_INT32:
        return readAs<std::int32_t, float>();
      case DT_FLOAT32:
        return readAs<float, float>();
      case DT_FLOAT64:
        return readAs<double, float>();
      case DT_INT8:
        return readAs<std::int8_t, std::int16_t>();
      case DT_UINT16:
        return readAs<std::uint16_t, std::uint16_t>();
      case DT_UINT32:
        return readAs<std::uint32_t, float>();
      case DT_INT64:
        return readAs<std::int64_t, float>();
      case DT_UINT64:
        return readAs<std::uint64_t, float>();
      default:
        throw unsupported(m_path.string() + ": its NIfTI datatype is " +
                          std::to_string(m_header.fields.datatype) +
                          "; expected integers of 8 to 64 bits, floats or doubles");
    }
  }

private:
  template <class From, class To>
  Voxels readAs() {
    std::vector<From> raw = readRaw<From>();
    const double slope = static_cast<double>(m_header.fields.scl_slope);
    const double intercept = static_cast<double>(m_header.fields.scl_inter);
    if (slope != 0 && (slope != 1 || intercept != 0))
      return converted<float>(raw,
                              [=](From v) { return slope * static_cast<double>(v) + intercept; });
    if constexpr (std::is_same_v<From, To>)
      return raw;
    else
      return converted<To>(raw, [](From v) { return v; });
  }

  template <class To, class From, class Function>
  static std::vector<To> converted(const std::vector<From>& raw, Function function) {
    std::vector<To> out(raw.size());
    std::transform(raw.begin(), raw.end(), out.begin(),
                   [&](From v) { return static_cast<To>(function(v)); });
    return out;
  }

  template <class T>
  std::vector<T> readRaw() {
    const auto start =
        static_cast<z_off_t>(std::max(static_cast<double>(m_header.fields.vox_offset), 348.0));
    if (gzseek(m_file, start, SEEK_SET) != start) refuseTruncated(0, m_count * sizeof(T));
    std::vector<T> raw(m_count);
    readBytes(reinterpret_cast<char*>(raw.data()), m_count * sizeof(T));
    if (m_header.swapped && sizeof(T) > 1)
      nifti_swap_Nbytes(m_count, static_cast<int>(sizeof(T)), raw.data());
    return raw;
  }

  void readBytes(char* to, std::size_t size) {
    for (std::size_t done = 0; done < size;) {
      m_progress.check();
      const auto wanted = static_cast<unsigned>(std::min(kChunk, size - done));
      const int got = gzread(m_file, to + done, wanted);
      if (got != static_cast<int>(wanted))
        refuseTruncated(done + static_cast<std::size_t>(std::max(got, 0)), size);
      done += wanted;
    }
    // the checksum of a gzip stream follows its last byte, and is compared when that is read
    std::vector<char> rest(1 << 16);
    int got = gzdirect(m_file) != 0 ? 0 : 1;
    while (got > 0) got = gzread(m_file, rest.data(), static_cast<unsigned>(rest.size()));
    int error = Z_OK;
    gzerror(m_file, &error);
    if (got < 0 || error != Z_OK)
      throw invalidInput(m_path.string() + ": its gzip stream is truncated or damaged");
  }

  [[noreturn]] void refuseTruncated(std::size_t got, std::size_t size) const {
    throw invalidInput(m_path.string() + ": truncated or damaged: " + std::to_string(got) + " of " +
                       std::to_string(size) + " bytes of voxels can be read");
  }

  gzFile m_file;
  const Header& m_header;
  std::size_t m_count;
  const fs::path& m_path;
  const Progress& m_progress;
};

short datatypeOf(const Voxels& voxels) {
  constexpr std::array<short, 4> kTypes = {DT_UINT8, DT_INT16, DT_UINT16, DT_FLOAT32};
  return kTypes[voxels.index()];
}

void writeBytes(gzFile file, const void* bytes, std::size_t size, const fs::path& path) {
  const auto* from = static_cast<const char*>(bytes);
  for (std::size_t done = 0; done < size;) {
    const auto count = static_cast<unsigned>(std::min(kChunk, size - done));
    if (gzwrite(file, from + done, count) != static_cast<int>(count))
      throw failed(path.string() + ": cannot be written");
    done += count;
  }
}

}  // namespace

Volume readNifti(const fs::path& path, const ReadVolumeOptions& /*options*/,
                 const Progress& progress) {
  const GzFile file = openFile(path);
  const Header header = readHeader(file.get(), path);
  checkType(header.fields.datatype, path);
  checkSizes(header.fields, path);
  checkFileHolds(header.fields, gzdirect(file.get()) == 0, path);
  Volume volume;
  volume.geometry = niftiGeometry(header.fields, path);
  checkGeometry(volume.geometry, path);
  progress.check();
  const std::size_t count = volume.geometry.voxelCount();
  volume.voxels = VoxelReader(file.get(), header, count, path, progress).read();
  return volume;
}

VolumeHeader readNiftiHeader(const fs::path& path, const ReadVolumeOptions& options,
                             const Progress& progress) {
  Volume volume = readNifti(path, options, progress);
  return {.geometry = volume.geometry, .assumptions = std::move(volume.assumptions)};
}

void writeNifti(const Volume& volume, const fs::path& file, bool compressed, const fs::path& name) {
  const nifti_1_header header = niftiHeader(volume.geometry, datatypeOf(volume.voxels), name);
  GzFile stream(gzopen(file.c_str(), compressed ? "wb" : "wbT"), gzclose);
  if (!stream) throw failed(name.string() + ": cannot be written");
  constexpr std::array<char, 4> kNoExtensions{};
  writeBytes(stream.get(), &header, sizeof(header), name);
  writeBytes(stream.get(), kNoExtensions.data(), kNoExtensions.size(), name);
  std::visit(
      [&](const auto& voxels) {
        writeBytes(stream.get(), voxels.data(), voxels.size() * sizeof(voxels[0]), name);
      },
      volume.voxels);
  if (gzclose(stream.release()) != Z_OK) throw failed(name.string() + ": cannot be written");
}

}  // namespace lumen::convert
