// SPDX-License-Identifier: Apache-2.0
// Volumes: header and voxels of a file, and folders of DICOM files.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <unistd.h>

#include "converters/base/error.h"
#include "converters/io/volume/dicom/dicom_tree.h"
#include "converters/io/volume/read_volume.h"
#include "fuzz/fuzz.h"

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

  [[nodiscard]] fs::path write(const std::string& name, std::string_view text) const {
    std::ofstream file(m_path / name, std::ios::binary | std::ios::trunc);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
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

void readBoth(const InputFile& path, convert::VolumeFormat format,
              const convert::ReadVolumeOptions& options = {}) {
  const Progress silent;
  const auto header =
      accepted([&] { return convert::readVolumeHeader(path, format, options, silent); });
  if (header) checkGeometry(header->geometry);
  // voxels of 1032 times the file are legal, but too slow for many inputs
  constexpr std::uint64_t kMostBytes = 1 << 24;
  if (header && (header->voxelBytes > kMostBytes || header->geometry.voxelCount() > kMostBytes))
    return;
  const auto volume = accepted([&] { return convert::readVolume(path, format, options, silent); });
  if (!volume) return;
  expect(header.has_value(), "a volume that is read has a header");
  expect(header->geometry.size == volume->geometry.size, "both say the same size");
  checkGeometry(volume->geometry);
  const std::size_t count = std::visit([](const auto& v) { return v.size(); }, volume->voxels);
  expect(count == volume->geometry.voxelCount(), "there are as many voxels as the size says");
}

/// A file `name` with these bytes, in a folder of this process where the same bytes are also in the file
/// "d", for headers that name one.
/// From memory; from a folder only where the text may name the detached file "d" there.
void readVolumeOf(std::span<const std::byte> input, const std::string& name,
                  convert::VolumeFormat format) {
  const std::string_view text = textOf(input);
  const bool mayDetach = text.find("data file") != text.npos ||
                         text.find("datafile") != text.npos ||
                         (text.find("ElementDataFile") != text.npos &&
                          text.find("ElementDataFile = LOCAL") == text.npos);
  if (!mayDetach) return readBoth(InputFile(name, text), format);
  static const Folder folder;
  (void)folder.write("d", text);
  readBoth(folder.write(name, text), format);
}

void nrrd(std::span<const std::byte> input) {
  readVolumeOf(input, "v.nrrd", convert::VolumeFormat::Nrrd);
}

void metaImage(std::span<const std::byte> input) {
  readVolumeOf(input, "v.mha", convert::VolumeFormat::MetaImage);
}

void nifti(std::span<const std::byte> input) {
  readVolumeOf(input, "v.nii", convert::VolumeFormat::Nifti);
}

#ifdef LUMEN_WITH_DICOM
/// A folder with a DICOM file, or with several, between which the bytes have the word "#next-file#".
void dicom(std::span<const std::byte> input) {
  constexpr std::string_view kNext = "#next-file#";
  constexpr std::size_t kMostFiles = 4;
  std::vector<InputFile> files;
  std::string_view rest = textOf(input);
  for (std::size_t n = 0; n < kMostFiles; ++n) {
    const std::size_t end = rest.find(kNext);
    files.emplace_back("folder/" + std::to_string(n), rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + kNext.size());
  }
  convert::ReadVolumeOptions filled;
  filled.fillGaps = true;
  readBoth(InputFile("folder", files), convert::VolumeFormat::Dicom, filled);
}

/// A file of DICOM that stands for itself: frames, a segmentation, a structure set; and its names.
void dicomFile(std::span<const std::byte> input) {
  const InputFile file("a.dcm", textOf(input));
  convert::ReadVolumeOptions options;
  options.allowsConstant = true;
  readBoth(file, convert::VolumeFormat::Dicom, options);
  for (const convert::DicomSegment& segment : convert::dicomSegments(file))
    expect(segment.number <= convert::kMostLabel, "numbers of segments are labels");
}
#endif

constexpr Target kTargets[] = {
#ifdef LUMEN_WITH_DICOM
    {"dicom", dicom},
    {"dicom_file", dicomFile},
#endif
    {"nrrd", nrrd},
    {"metaimage", metaImage},
    {"nifti", nifti}};

}  // namespace

std::span<const Target> volumeTargets() {
  return kTargets;
}

}  // namespace lumen::fuzz
