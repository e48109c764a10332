// SPDX-License-Identifier: Apache-2.0
#include "converters/volume/dicom_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <gdcmReader.h>
#include <gdcmTag.h>
#include <gdcmTrace.h>
#include <itkObject.h>

namespace lumen::convert {
namespace {

std::size_t littleEndian32(const std::string& bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= static_cast<std::size_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

}  // namespace

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
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  const std::string tag("\xe0\x7f\x10\x00", 4);
  // the length follows the tag (implicit types), or a type of two letters and two zero bytes
  for (auto at = content.rfind(tag); at != std::string::npos && at > 0;
       at = content.rfind(tag, at - 1))
    for (const std::size_t skip : {4U, 8U}) {
      if (at + skip + 4 > content.size()) continue;
      const std::size_t length = littleEndian32(content, at + skip);
      if (length == bytes || length == bytes + bytes % 2)
        return at + skip + 4 + bytes <= content.size();
    }
  return true;
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
