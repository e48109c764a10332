// SPDX-License-Identifier: Apache-2.0
// What ITK's DICOM reader does not tell about a file.
#pragma once

#include <cstddef>
#include <filesystem>

namespace lumen::convert {

/// While one lives, ITK and GDCM do not print warnings; what matters among them is an Error here.
/// Not thread-safe: the switches are global.
class QuietDicom {
public:
  QuietDicom();
  ~QuietDicom();
  QuietDicom(const QuietDicom&) = delete;
  QuietDicom& operator=(const QuietDicom&) = delete;

private:
  bool m_itk, m_warning, m_error, m_debug;
};

/// False if uncompressed pixel data of `bytes` bytes begins in `file` and goes beyond its end,
/// which GDCM would fill up. Compressed pixel data is left to the decoder.
bool hasWholePixelData(const std::filesystem::path& file, std::size_t bytes);

/// True if a multi-frame file says how far its frames are apart. If not, GDCM takes 1 mm.
bool hasFrameSpacing(const std::filesystem::path& file);

}  // namespace lumen::convert
