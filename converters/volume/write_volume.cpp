// SPDX-License-Identifier: Apache-2.0
#include "converters/volume/write_volume.h"

#include <cstdint>
#include <memory>
#include <system_error>

#include <fcntl.h>
#include <openssl/evp.h>
#include <unistd.h>

#include "converters/common/error.h"
#include "converters/volume/itk_image.h"
#include "converters/volume/nifti_file.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using Component = itk::IOComponentEnum;

Component componentOf(const std::vector<std::uint8_t>&) {
  return Component::UCHAR;
}
Component componentOf(const std::vector<std::int16_t>&) {
  return Component::SHORT;
}
Component componentOf(const std::vector<std::uint16_t>&) {
  return Component::USHORT;
}
Component componentOf(const std::vector<float>&) {
  return Component::FLOAT;
}

/// Removes a file that was not renamed.
struct TemporaryFile {
  fs::path path;
  ~TemporaryFile() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

/// A hidden sibling of `path` with the whole of its name, so that the format is the same.
fs::path temporarySibling(const fs::path& path) {
  return path.parent_path() / (".tmp-" + std::to_string(getpid()) + "-" + path.filename().string());
}

void setGeometry(itk::ImageIOBase& io, const VolumeGeometry& geometry) {
  io.SetNumberOfDimensions(3);
  itk::ImageIORegion region(3);
  for (unsigned a = 0; a < 3; ++a) {
    const auto e = static_cast<Eigen::Index>(a);
    io.SetDimensions(a, static_cast<unsigned>(geometry.size[a]));
    io.SetSpacing(a, geometry.spacing[e]);
    io.SetOrigin(a, geometry.origin[e]);
    const Eigen::Vector3d column = geometry.direction.col(e);
    io.SetDirection(a, std::vector<double>(column.data(), column.data() + 3));
    region.SetIndex(a, 0);
    region.SetSize(a, static_cast<itk::SizeValueType>(geometry.size[a]));
  }
  io.SetIORegion(region);
}

void flushToDisk(const fs::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const bool flushed = descriptor >= 0 && fsync(descriptor) == 0;
  if (descriptor >= 0) close(descriptor);
  if (!flushed) throw failed(file.string() + ": cannot be flushed to disk");
}

struct Digest {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

std::string sha256(const void* bytes, std::size_t size) {
  const std::unique_ptr<EVP_MD_CTX, Digest> context(EVP_MD_CTX_new());
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  if (!context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1 ||
      EVP_DigestUpdate(context.get(), bytes, size) != 1 ||
      EVP_DigestFinal_ex(context.get(), digest.data(), &length) != 1)
    throw failed("the cryptography library offers no SHA-256");
  std::string hex;
  for (unsigned i = 0; i < length; ++i) {
    hex += "0123456789abcdef"[digest[i] >> 4];
    hex += "0123456789abcdef"[digest[i] & 15];
  }
  return hex;
}

void writeWithItk(const Volume& volume, const fs::path& path, VolumeFormat format,
                  bool compressed) {
  const auto io = makeImageIo(format);
  setGeometry(*io, volume.geometry);
  io->SetPixelType(itk::IOPixelEnum::SCALAR);
  io->SetNumberOfComponents(1);
  io->SetUseCompression(compressed);
  io->SetFileName(path.string());
  try {
    std::visit(
        [&](const auto& voxels) {
          io->SetComponentType(componentOf(voxels));
          io->WriteImageInformation();
          io->Write(voxels.data());
        },
        volume.voxels);
  } catch (const itk::ExceptionObject& exception) {
    throw failed(path.string() + ": cannot be written (" + oneLine(exception) + ")");
  }
}

}  // namespace

void writeVolume(const Volume& volume, const fs::path& path, VolumeFormat format, bool compressed) {
  if (format == VolumeFormat::Dicom) throw unsupported(path.string() + ": DICOM is not written");
  const TemporaryFile temporary{temporarySibling(path)};
  if (format == VolumeFormat::Nifti)
    writeNifti(volume, temporary.path, compressed);
  else
    writeWithItk(volume, temporary.path, format, compressed);
  flushToDisk(temporary.path);
  std::error_code error;
  fs::rename(temporary.path, path, error);
  if (error) throw failed(path.string() + ": cannot be written (" + error.message() + ")");
}

formats::SourceVolume describeSource(const Volume& volume) {
  const auto& g = volume.geometry;
  formats::SourceVolume source;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto e = static_cast<Eigen::Index>(a);
    source.size[a] = static_cast<std::uint32_t>(g.size[a]);
    source.spacing[a] = g.spacing[e];
    source.origin[a] = g.origin[e];
    for (std::size_t c = 0; c < 3; ++c)
      source.direction[3 * a + c] = g.direction(e, static_cast<Eigen::Index>(c));
  }
  source.sha256 = std::visit(
      [](const auto& v) { return sha256(v.data(), v.size() * sizeof(v[0])); }, volume.voxels);
  return source;
}

}  // namespace lumen::convert
