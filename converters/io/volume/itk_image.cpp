// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/itk_image.h"

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkMultiThreaderBase.h>
#include <itkNrrdImageIO.h>

namespace lumen::convert {
namespace {

/// The writer is named here rather than found through ITK's factories, which every program would
/// have to register first.
itk::ImageIOBase::Pointer makeImageIo(VolumeFormat format) {
  if (format == VolumeFormat::Nrrd) return itk::NrrdImageIO::New().GetPointer();
  return itk::MetaImageIO::New().GetPointer();
}

itk::IOComponentEnum componentOf(const Voxels& voxels) {
  using Component = itk::IOComponentEnum;
  constexpr std::array kTypes = {Component::UCHAR, Component::SHORT, Component::USHORT,
                                 Component::FLOAT};
  return kTypes.at(voxels.index());
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

}  // namespace

bool writeWithItk(const Volume& volume, const std::filesystem::path& file, VolumeFormat format,
                  bool compressed, const VolumeNotes& notes) {
  try {
    const auto io = makeImageIo(format);
    setGeometry(*io, volume.geometry);
    io->SetPixelType(itk::IOPixelEnum::SCALAR);
    io->SetNumberOfComponents(1);
    io->SetComponentType(componentOf(volume.voxels));
    io->SetUseCompression(compressed);
    io->SetFileName(file.string());
    for (const auto& [key, text] : notes)
      itk::EncapsulateMetaData<std::string>(io->GetMetaDataDictionary(), key, text);
    io->WriteImageInformation();
    std::visit([&](const auto& voxels) { io->Write(voxels.data()); }, volume.voxels);
    return true;
  } catch (const itk::ExceptionObject&) {
    return false;
  }
}

void limitItkThreads(int threads) {
  itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(static_cast<itk::ThreadIdType>(threads));
}

}  // namespace lumen::convert
