// SPDX-License-Identifier: Apache-2.0
// Small files for the tests of volumes and seeds.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/io/volume/read_volume.h"
#include "converters/io/volume/write_volume.h"

namespace lumen::convert {

/// A directory of its own for each test, removed at its end.
class FileTest : public testing::Test {
protected:
  FileTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    m_directory =
        std::filesystem::temp_directory_path() /
        ("lumen-" + std::to_string(getpid()) + "-" + info->test_suite_name() + "-" + info->name());
    std::filesystem::create_directories(m_directory);
  }
  ~FileTest() override { std::filesystem::remove_all(m_directory); }

  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return m_directory / name;
  }
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  [[nodiscard]] static std::string bytesOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// Cuts `count` bytes off the end.
  static void truncate(const std::filesystem::path& file, std::uintmax_t count) {
    std::filesystem::resize_file(file, std::filesystem::file_size(file) - count);
  }

private:
  std::filesystem::path m_directory;
};

/// "KIND: message" of what `action` throws, such as "3: no such file"; empty if it throws nothing.
inline std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return std::to_string(static_cast<int>(error.kind())) + ": " + error.what();
  }
  return {};
}

/// The format that these tests' files have by their names; a folder is one of DICOM.
inline const VolumeFormat& formatOf(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".nrrd" || extension == ".nhdr") return VolumeFormat::Nrrd;
  if (extension == ".mha" || extension == ".mhd") return VolumeFormat::MetaImage;
  if (extension == ".nii" || extension == ".gz") return VolumeFormat::Nifti;
  return VolumeFormat::Dicom;
}

/// The options, with fields that messages name as a command line does: "--spacing".
inline ReadVolumeOptions worded(ReadVolumeOptions options) {
  options.word = FieldWord([](auto field, auto) { return std::string("--").append(field); });
  return options;
}

inline Volume readQuietly(const std::filesystem::path& path,
                          const ReadVolumeOptions& options = {}) {
  const Progress silent;
  return readVolume(path, formatOf(path), worded(options), silent);
}

/// Compressed, but for a name in .nii.
inline void writeAsNamed(const Volume& volume, const std::filesystem::path& path) {
  writeNewFile(encodeVolume(volume, formatOf(path), path.extension() != ".nii", path), path);
}

inline std::string readRefusal(const std::filesystem::path& path,
                               const ReadVolumeOptions& options = {}) {
  return refusal([&] { (void)readQuietly(path, options); });
}

/// Synthetic voxels: value(i, j, k) cast to T.
template <class T>
Volume makeVolume(std::array<int, 3> size, const std::function<double(int, int, int)>& value) {
  Volume volume;
  volume.geometry.size = size;
  std::vector<T> voxels;
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j)
      for (int i = 0; i < size[0]; ++i) voxels.push_back(static_cast<T>(value(i, j, k)));
  volume.voxels = std::move(voxels);
  return volume;
}

/// The bytes of `values`, little-endian on the machines that this runs on.
template <class T>
std::string bytes(const std::vector<T>& values) {
  std::string out(values.size() * sizeof(T), '\0');
  if (!values.empty()) std::memcpy(out.data(), values.data(), out.size());
  return out;
}

inline void expectRefused(const std::string& refused, const std::vector<std::string>& words) {
  for (const auto& word : words)
    EXPECT_NE(refused.find(word), std::string::npos) << "\"" << word << "\" is not in: " << refused;
  EXPECT_EQ(refused.find('\n'), std::string::npos) << refused;
}

// NIfTI files made by hand.
/// NIfTI-1 with an identity sform.
struct MadeNiftiHeader {
  std::array<std::int16_t, 8> dim{3, 2, 2, 2, 1, 1, 1, 1};
  std::array<float, 8> pixdim{1, 1, 1, 1, 1, 1, 1, 1};
  std::int16_t type = 2, bits = 8;
  float slope = 0, intercept = 0;
  [[nodiscard]] std::string text() const {
    std::string h(352, '\0');
    const auto put = [&](std::size_t at, const auto& value) {
      std::memcpy(h.data() + at, &value, sizeof(value));
    };
    put(0, std::int32_t{348});
    put(40, dim);
    put(70, type);
    put(72, bits);
    put(76, pixdim);
    put(108, 352.0F);
    put(112, slope);
    put(116, intercept);
    put(254, std::int16_t{1});
    put(280, 1.0F);
    put(300, 1.0F);
    put(320, 1.0F);
    std::memcpy(h.data() + 344, "n+1", 4);
    return h;
  }
};

inline std::string gzipped(const std::string& text, const std::filesystem::path& scratch) {
  gzFile file = gzopen(scratch.c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  std::ifstream stream(scratch, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace lumen::convert
