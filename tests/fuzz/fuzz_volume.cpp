// SPDX-License-Identifier: Apache-2.0
// Volumes of the format LUMEN_FUZZ_FORMAT, header and voxels: what is accepted must be sound, and what
// is refused must be refused as a stage must.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include <unistd.h>

#include "converters/base/error.h"
#include "converters/io/volume/read_volume.h"
#include "fuzz/fuzz_support.h"

namespace lumen::fuzz {
namespace {

namespace fs = std::filesystem;

/// A folder for the life of the program.
class Folder {
public:
  Folder() : m_path(fs::temp_directory_path() / ("lumen-fuzz-" + std::to_string(getpid()))) {
    fs::create_directories(m_path);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(m_path, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] fs::path write(const std::string& name, const std::uint8_t* data,
                               std::size_t size) const {
    std::ofstream file(m_path / name, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    expect(file.good(), "the file can be written");
    return m_path / name;
  }

private:
  fs::path m_path;
};

void checkGeometry(const convert::VolumeGeometry& g) {
  for (int a = 0; a < 3; ++a) {
    expect(g.size[static_cast<std::size_t>(a)] >= 2, "each axis has two voxels");
    expect(std::isfinite(g.spacing[a]) && g.spacing[a] > 0, "spacings are positive");
  }
  expect(g.origin.allFinite(), "the origin is finite");
  const Eigen::Matrix3d off = g.direction.transpose() * g.direction - Eigen::Matrix3d::Identity();
  expect(off.cwiseAbs().maxCoeff() < 1e-9, "directions are orthonormal");
}

template <class Read>
auto accepted(Read read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::InvalidInput || error.kind() == ErrorKind::Unsupported,
           "a bad volume is invalid input or unsupported");
    const std::string text = error.what();
    for (const char c : text)  // a list of series has lines
      expect(static_cast<unsigned char>(c) >= ' ' || c == '\n',
             "a message has no control characters");
    return {};
  }
}

void readBoth(const fs::path& path, convert::VolumeFormat format) {
  const Progress silent;
  const auto header = accepted([&] { return convert::readVolumeHeader(path, format, {}, silent); });
  if (header) checkGeometry(header->geometry);
  // voxels of 1032 times the file are legal, but too slow for many inputs
  constexpr std::uint64_t kMostBytes = 1 << 24;
  if (header && header->voxelBytes > kMostBytes) return;
  const auto volume = accepted([&] { return convert::readVolume(path, format, {}, silent); });
  if (!volume) return;
  expect(header.has_value(), "a volume that is read has a header");
  expect(header->geometry.size == volume->geometry.size, "both say the same size");
  checkGeometry(volume->geometry);
  const std::size_t count = std::visit([](const auto& v) { return v.size(); }, volume->voxels);
  expect(count == volume->geometry.voxelCount(), "there are as many voxels as the size says");
}

/// The same bytes are also in the file "d", for headers that name one.
void readVolumeOf(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  (void)folder.write("d", data, size);
  readBoth(folder.write("v", data, size), convert::VolumeFormat::LUMEN_FUZZ_FORMAT);
}

/// A folder with a DICOM file of these bytes, or with several, between which the bytes have the word
/// "#next-file#".
void readSeriesOf(const std::uint8_t* data, std::size_t size) {
  constexpr std::string_view kNext = "#next-file#";
  constexpr std::size_t kMostFiles = 4;
  static const Folder folder;
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  fs::path file;
  for (std::size_t n = 0; n < kMostFiles; ++n) {
    const std::size_t end = rest.find(kNext);
    const std::string_view part = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + kNext.size());
    file = folder.write(std::to_string(n), reinterpret_cast<const std::uint8_t*>(part.data()),
                        part.size());
  }
  readBoth(file.parent_path(), convert::VolumeFormat::Dicom);
}

}  // namespace
}  // namespace lumen::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using lumen::convert::VolumeFormat;
  constexpr VolumeFormat kFormat = VolumeFormat::LUMEN_FUZZ_FORMAT;
  if (kFormat == VolumeFormat::Dicom)
    lumen::fuzz::readSeriesOf(data, size);
  else
    lumen::fuzz::readVolumeOf(data, size);
  return 0;
}
