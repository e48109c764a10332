// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/itk_image.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>
#include <sstream>
#include <type_traits>
#include <vector>

#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>

#include "converters/base/error.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

std::string sizesText(const itk::ImageIOBase& io) {
  std::ostringstream text;
  for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a)
    text << (a ? " x " : "") << io.GetDimensions(a);
  return text.str();
}

void checkScalar(const itk::ImageIOBase& io, const fs::path& path) {
  if (io.GetNumberOfComponents() == 1 && io.GetPixelType() == itk::IOPixelEnum::SCALAR) return;
  throw invalidInput(path.string() + ": each voxel has " +
                     std::to_string(io.GetNumberOfComponents()) + " components (" +
                     itk::ImageIOBase::GetPixelTypeAsString(io.GetPixelType()) +
                     "); expected one number");
}

void checkDimensions(const itk::ImageIOBase& io, const fs::path& path) {
  const unsigned dimensions = io.GetNumberOfDimensions();
  if (dimensions < 3) refuseDimensions(path, dimensions, sizesText(io));
  for (unsigned a = 3; a < dimensions; ++a)
    if (io.GetDimensions(a) != 1) refuseDimensions(path, dimensions, sizesText(io));
}

/// Reads pixels of type From into a vector of To.
template <class From, class To>
Voxels readAs(itk::ImageIOBase& io) {
  const auto count = static_cast<std::size_t>(io.GetImageSizeInPixels());
  std::vector<To> voxels;
  if constexpr (std::is_same_v<From, To>) {
    voxels.resize(count);
    io.Read(voxels.data());
  } else {
    std::vector<From> raw(count);
    io.Read(raw.data());
    voxels.resize(count);
    std::transform(raw.begin(), raw.end(), voxels.begin(),
                   [](From v) { return static_cast<To>(v); });
  }
  return voxels;
}

Voxels readComponents(itk::ImageIOBase& io, const fs::path& path) {
  using Component = itk::IOComponentEnum;
  switch (io.GetComponentType()) {
    case Component::UCHAR:
      return readAs<std::uint8_t, std::uint8_t>(io);
    case Component::CHAR:
      return readAs<std::int8_t, std::int16_t>(io);
    case Component::USHORT:
      return readAs<std::uint16_t, std::uint16_t>(io);
    case Component::SHORT:
      return readAs<std::int16_t, std::int16_t>(io);
    case Component::UINT:
      return readAs<unsigned int, float>(io);
    case Component::INT:
      return readAs<int, float>(io);
    case Component::ULONG:
      return readAs<unsigned long, float>(io);
    case Component::LONG:
      return readAs<long, float>(io);
    case Component::ULONGLONG:
      return readAs<unsigned long long, float>(io);
    case Component::LONGLONG:
      return readAs<long long, float>(io);
    case Component::FLOAT:
      return readAs<float, float>(io);
    case Component::DOUBLE:
      return readAs<double, float>(io);
    default:
      break;
  }
  throw unsupported(path.string() + ": its pixel type is " +
                    itk::ImageIOBase::GetComponentTypeAsString(io.GetComponentType()) +
                    "; expected integers of 8 to 64 bits, floats or doubles");
}

}  // namespace

itk::ImageIOBase::Pointer makeImageIo(VolumeFormat format) {
  if (format == VolumeFormat::Nrrd) return itk::NrrdImageIO::New().GetPointer();
  return itk::MetaImageIO::New().GetPointer();
}

VolumeGeometry checkedGeometry(const itk::ImageIOBase& io, const fs::path& path) {
  checkDimensions(io, path);
  checkScalar(io, path);
  VolumeGeometry geometry;
  for (unsigned a = 0; a < 3; ++a) {
    if (io.GetDimensions(a) > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw invalidInput(path.string() + ": has " + std::to_string(io.GetDimensions(a)) +
                         " voxels along axis " + std::to_string(a + 1) +
                         "; expected at most 2^31 - 1");
    geometry.size[a] = static_cast<int>(io.GetDimensions(a));
    const auto e = static_cast<Eigen::Index>(a);
    geometry.spacing[e] = io.GetSpacing(a);
    geometry.origin[e] = io.GetOrigin(a);
    const std::vector<double> column = io.GetDirection(a);
    for (unsigned r = 0; r < 3; ++r)
      geometry.direction(static_cast<Eigen::Index>(r), e) = column[r];
  }
  checkGeometry(geometry, path);
  return geometry;
}

Voxels readVoxels(itk::ImageIOBase& io, const fs::path& path) {
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) {
    region.SetIndex(a, 0);
    region.SetSize(a, io.GetDimensions(a));
  }
  io.SetIORegion(region);
  try {
    return readComponents(io, path);
  } catch (const itk::ExceptionObject& exception) {
    throw invalidInput(path.string() +
                       ": its voxels cannot be read, so it is truncated or damaged (" +
                       oneLine(exception) + ")");
  } catch (const std::bad_alloc&) {
    throw invalidInput(path.string() + ": its " + sizesText(io) + " voxels do not fit in memory");
  }
}

std::string oneLine(const itk::ExceptionObject& exception) {
  std::string text = exception.GetDescription();
  std::replace(text.begin(), text.end(), '\n', ' ');
  const auto object = text.find("): ");  // ITK begins with "itk::ERROR: Class(address): "
  if (text.rfind("itk::ERROR", 0) == 0 && object != std::string::npos)
    text = text.substr(object + 3);
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text;
}

}  // namespace lumen::convert
