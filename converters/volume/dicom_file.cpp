// SPDX-License-Identifier: Apache-2.0
#include "converters/volume/dicom_file.h"

#include <algorithm>
#include <fstream>
#include <set>

#include <gdcmReader.h>
#include <gdcmTag.h>
#include <gdcmTrace.h>
#include <itkObject.h>

namespace lumen::convert {

QuietDicom::QuietDicom()
    : m_itk(itk::Object::GetGlobalWarningDisplay()),
      m_warning(gdcm::Trace::GetWarningFlag()),
      m_error(gdcm::Trace::GetErrorFlag()),
      m_debug(gdcm::Trace::GetDebugFlag()) {
  itk::Object::SetGlobalWarningDisplay(false);
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  gdcm::Trace::DebugOff();
}

QuietDicom::~QuietDicom() {
  itk::Object::SetGlobalWarningDisplay(m_itk);
  gdcm::Trace::SetWarning(m_warning);
  gdcm::Trace::SetError(m_error);
  gdcm::Trace::SetDebug(m_debug);
}

bool hasWholePixelData(const std::filesystem::path& file, std::size_t bytes) {
  const gdcm::Tag tag(0x7fe0, 0x0010);
  std::ifstream stream(file, std::ios::binary);
  gdcm::Reader reader;
  reader.SetStream(stream);
  constexpr bool kReadValues = false;  // they are skipped, beyond the file's end if need be
  if (!reader.ReadSelectedTags({tag}, kReadValues)) return true;
  const auto syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
  const gdcm::DataElement& pixels = reader.GetFile().GetDataSet().GetDataElement(tag);
  const bool packed =
      syntax.IsEncapsulated() || syntax == gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian;
  if (packed || pixels.IsEmpty() || pixels.GetVL().IsUndefined()) return true;
  const std::size_t length = pixels.GetVL(), end = reader.GetStreamCurrentPosition();
  return length >= bytes && end - length + bytes <= std::filesystem::file_size(file);
}

bool hasFrameSpacing(const std::filesystem::path& file) {
  // spacing between slices, grid frame offsets, shared and per-frame functional groups
  const std::set<gdcm::Tag> tags{gdcm::Tag(0x0018, 0x0088), gdcm::Tag(0x3004, 0x000c),
                                 gdcm::Tag(0x5200, 0x9229), gdcm::Tag(0x5200, 0x9230)};
  gdcm::Reader reader;
  reader.SetFileName(file.c_str());
  if (!reader.ReadSelectedTags(tags)) return false;
  const auto& found = reader.GetFile().GetDataSet();
  return std::any_of(tags.begin(), tags.end(),
                     [&](const gdcm::Tag& tag) { return found.FindDataElement(tag); });
}

}  // namespace lumen::convert
