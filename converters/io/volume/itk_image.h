// SPDX-License-Identifier: Apache-2.0
// Between ITK's image readers and lumen's volumes. Private to the sources that include ITK.
#pragma once

#include <filesystem>
#include <string>

#include <itkImageIOBase.h>

#include "converters/io/volume/read_volume.h"

namespace lumen::convert {

/// The reader and writer of NRRD or MetaImage. Readers are named here rather than found through
/// ITK's factories, which every program would have to register first.
itk::ImageIOBase::Pointer makeImageIo(VolumeFormat format);

/// The geometry that `io` has read from a header. Throws Error(InvalidInput), naming `path`, unless
/// it is 3-D (a further axis of one entry is dropped) and scalar with a sound geometry.
VolumeGeometry checkedGeometry(const itk::ImageIOBase& io, const std::filesystem::path& path);

/// The voxels of `io`, whose header has been read, in the in-memory type that holds them.
Voxels readVoxels(itk::ImageIOBase& io, const std::filesystem::path& path);

/// What an ITK exception says, on one line, without places in ITK's sources.
std::string oneLine(const itk::ExceptionObject& exception);

}  // namespace lumen::convert
