// SPDX-License-Identifier: Apache-2.0
#include "converters/volume/nifti_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <zlib.h>

#include "converters/common/error.h"
#include "converters/volume/volume_header.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeaderBytes = 348;
constexpr std::size_t kChunk = 16 << 20;

/// zlib reads plain files through the same functions.
using GzFile = std::unique_ptr<gzFile_s, int (*)(gzFile)>;

GzFile openFile(const fs::path& path) {
  GzFile file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw invalidInput(path.string() + ": cannot be opened");
  gzbuffer(file.get(), 1 << 18);
  return file;
}

/// The fields that are used here (nifti1.h, R. W. Cox, 2003).
struct Header {
  std::array<unsigned char, kHeaderBytes> bytes{};
  bool swapped = false;

  template <class T>
  [[nodiscard]] T at(std::size_t offset) const {
    std::array<unsigned char, sizeof(T)> raw{};
    std::memcpy(raw.data(), &bytes[offset], sizeof(T));
    if (swapped) std::reverse(raw.begin(), raw.end());
    T value{};
    std::memcpy(&value, raw.data(), sizeof(T));
    return value;
  }
  [[nodiscard]] int dim(std::size_t i) const { return at<std::int16_t>(40 + 2 * i); }
  [[nodiscard]] int datatype() const { return at<std::int16_t>(70); }
  [[nodiscard]] int bits() const { return at<std::int16_t>(72); }
  [[nodiscard]] double pixdim(std::size_t i) const {
    return static_cast<double>(at<float>(76 + 4 * i));
  }
  [[nodiscard]] double voxelOffset() const { return static_cast<double>(at<float>(108)); }
  [[nodiscard]] double slope() const { return static_cast<double>(at<float>(112)); }
  [[nodiscard]] double intercept() const { return static_cast<double>(at<float>(116)); }
};

Header readHeader(gzFile file, const fs::path& path) {
  Header header;
  const int got = gzread(file, header.bytes.data(), static_cast<unsigned>(kHeaderBytes));
  if (got != static_cast<int>(kHeaderBytes))
    throw invalidInput(path.string() + ": truncated: " + std::to_string(std::max(got, 0)) +
                       " bytes can be read, but a NIfTI header has 348");
  const auto size = header.at<std::int32_t>(0);
  header.swapped = size != 348;
  if (size == 540 || header.at<std::int32_t>(0) == 540)
    throw unsupported(path.string() + ": is NIfTI-2; expected NIfTI-1");
  if (header.at<std::int32_t>(0) != 348 && size != 348)
    throw invalidInput(path.string() + ": is not a NIfTI file: its header size is not 348");
  if (std::memcmp(&header.bytes[344], "n+1", 4) != 0)
    throw invalidInput(path.string() +
                       ": is not a NIfTI file with its voxels inside: the magic "
                       "\"n+1\" is missing");
  return header;
}

class VoxelReader {
public:
  VoxelReader(const fs::path& path, std::size_t count, const Progress& progress)
      : m_path(path),
        m_count(count),
        m_progress(progress),
        m_file(openFile(path)),
        m_header(readHeader(m_file.get(), path)) {}

  Voxels read() {
    switch (m_header.datatype()) {
      case 2:
        return readAs<std::uint8_t, std::uint8_t>();
      case 4:
        return readAs<std::int16_t, std::int16_t>();
      case 8:
        return readAs<std::int32_t, float>();
      case 16:
        return readAs<float, float>();
      case 64:
        return readAs<double, float>();
      case 256:
        return readAs<std::int8_t, std::int16_t>();
      case 512:
        return readAs<std::uint16_t, std::uint16_t>();
      case 768:
        return readAs<std::uint32_t, float>();
      case 1024:
        return readAs<std::int64_t, float>();
      case 1280:
        return readAs<std::uint64_t, float>();
      default:
        throw unsupported(m_path.string() + ": its NIfTI datatype is " +
                          std::to_string(m_header.datatype()) +
                          "; expected integers of 8 to 64 bits, floats or doubles");
    }
  }

private:
  template <class From, class To>
  Voxels readAs() {
    std::vector<From> raw = readRaw<From>();
    const double slope = m_header.slope(), intercept = m_header.intercept();
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
    const auto start = static_cast<z_off_t>(std::max(m_header.voxelOffset(), 348.0));
    if (gzseek(m_file.get(), start, SEEK_SET) != start) refuseTruncated(0, m_count * sizeof(T));
    std::vector<T> raw(m_count);
    readBytes(reinterpret_cast<char*>(raw.data()), m_count * sizeof(T));
    if (m_header.swapped && sizeof(T) > 1)
      for (T& value : raw) {
        std::array<unsigned char, sizeof(T)> b{};
        std::memcpy(b.data(), &value, sizeof(T));
        std::reverse(b.begin(), b.end());
        std::memcpy(&value, b.data(), sizeof(T));
      }
    return raw;
  }

  void readBytes(char* to, std::size_t size) {
    for (std::size_t done = 0; done < size;) {
      m_progress.check();
      const auto wanted = static_cast<unsigned>(std::min(kChunk, size - done));
      const int got = gzread(m_file.get(), to + done, wanted);
      if (got != static_cast<int>(wanted))
        refuseTruncated(done + static_cast<std::size_t>(std::max(got, 0)), size);
      done += wanted;
    }
    // the checksum of a gzip stream follows its last byte, and is compared when that is read
    std::vector<char> rest(1 << 16);
    int got = gzdirect(m_file.get()) != 0 ? 0 : 1;
    while (got > 0) got = gzread(m_file.get(), rest.data(), static_cast<unsigned>(rest.size()));
    int error = Z_OK;
    gzerror(m_file.get(), &error);
    if (got < 0 || error != Z_OK)
      throw invalidInput(m_path.string() + ": its gzip stream is truncated or damaged");
  }

  [[noreturn]] void refuseTruncated(std::size_t got, std::size_t size) const {
    throw invalidInput(m_path.string() + ": truncated or damaged: " + std::to_string(got) + " of " +
                       std::to_string(size) + " bytes of voxels can be read");
  }

  const fs::path& m_path;
  std::size_t m_count;
  const Progress& m_progress;
  GzFile m_file;
  Header m_header;
};

}  // namespace

void checkNiftiHeader(const fs::path& path) {
  const GzFile file = openFile(path);
  const Header header = readHeader(file.get(), path);
  const int dimensions = header.dim(0);
  if (dimensions < 1 || dimensions > 7)
    throw invalidInput(path.string() + ": dim[0] is " + std::to_string(dimensions) +
                       "; expected 3");
  double needed = header.bits() / 8.0;
  for (int a = 1; a <= dimensions; ++a) {
    const auto u = static_cast<std::size_t>(a);
    if (header.dim(u) < 1)
      throw invalidInput(path.string() + ": dim[" + std::to_string(a) + "] is " +
                         std::to_string(header.dim(u)) + "; expected a positive count of voxels");
    needed *= header.dim(u);
    if (a <= 3) checkStatedSpacing(path, "pixdim", a, header.pixdim(u));
  }
  const double offset = header.voxelOffset();
  if (!(offset >= 0 && offset < 0x1p31))
    throw invalidInput(path.string() + ": its vox_offset is " + std::to_string(offset) +
                       "; expected 352");
  const bool compressed = gzdirect(file.get()) == 0;
  const double room = static_cast<double>(fs::file_size(path)) - (compressed ? 0 : offset);
  checkRoom(path, needed, room, compressed);
}

Voxels readNiftiVoxels(const fs::path& path, std::size_t count, const Progress& progress) {
  return VoxelReader(path, count, progress).read();
}

}  // namespace lumen::convert
