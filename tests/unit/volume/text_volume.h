// SPDX-License-Identifier: Apache-2.0
// Small files of NRRD and MetaImage, put together from their headers' lines.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "fixtures.h"

namespace lumen::convert {

/// Eight different bytes, for volumes of 2 x 2 x 2.
inline std::string eightBytes() {
  return "abcdefgh";
}

/// An NRRD file of 2 x 2 x 2 bytes; `lines` replace or add to the fields of an ordinary one, and a
/// line such as "-endian" takes one out.
inline std::string nrrdText(const std::vector<std::string>& lines,
                            const std::string& data = eightBytes()) {
  std::vector<std::string> fields = {"type: uint8", "dimension: 3", "sizes: 2 2 2",
                                     "endian: little", "encoding: raw"};
  for (const std::string& line : lines) {
    const bool drop = line[0] == '-';
    const std::string key = drop ? line.substr(1) + ":" : line.substr(0, line.find(':') + 1);
    std::erase_if(fields, [&](const std::string& field) { return field.rfind(key, 0) == 0; });
    if (!drop) fields.push_back(line);
  }
  std::string text = "NRRD0005\n";
  for (const std::string& field : fields) text += field + "\n";
  return text + "\n" + data;
}

/// A MetaImage of 2 x 2 x 2 bytes; `lines`, such as "NDims = 3", replace or add to the fields of an
/// ordinary one, and a line such as "-NDims" takes one out.
inline std::string metaText(const std::vector<std::string>& lines,
                            const std::string& data = eightBytes()) {
  std::vector<std::string> fields = {"ObjectType = Image",      "NDims = 3",
                                     "ElementSpacing = 1 1 1",  "DimSize = 2 2 2",
                                     "ElementType = MET_UCHAR", "ElementDataFile = LOCAL"};
  for (const std::string& line : lines) {
    const bool drop = line[0] == '-';
    const std::string key = drop ? line.substr(1) + " =" : line.substr(0, line.find('=') + 1);
    std::erase_if(fields, [&](const std::string& field) { return field.rfind(key, 0) == 0; });
    if (!drop)
      fields.insert(line.rfind("ElementDataFile", 0) == 0 ? fields.end() : fields.begin(), line);
  }
  std::string text;
  for (const std::string& field : fields) text += field + "\n";
  return text + data;
}

class TextVolume : public FileTest {
protected:
  [[nodiscard]] Volume nrrd(const std::vector<std::string>& lines,
                            const std::string& data = eightBytes(),
                            const ReadVolumeOptions& options = {}) const {
    return readQuietly(write("v.nrrd", nrrdText(lines, data)), options);
  }
  [[nodiscard]] Volume meta(const std::vector<std::string>& lines,
                            const std::string& data = eightBytes(),
                            const ReadVolumeOptions& options = {}) const {
    return readQuietly(write("v.mha", metaText(lines, data)), options);
  }
  [[nodiscard]] std::string nrrdRefusal(const std::vector<std::string>& lines,
                                        const std::string& data = eightBytes(),
                                        const ReadVolumeOptions& options = {}) const {
    return readRefusal(write("v.nrrd", nrrdText(lines, data)), options);
  }
  [[nodiscard]] std::string metaRefusal(const std::vector<std::string>& lines,
                                        const std::string& data = eightBytes(),
                                        const ReadVolumeOptions& options = {}) const {
    return readRefusal(write("v.mha", metaText(lines, data)), options);
  }
  /// The voxels as they would be in memory of 8 bit.
  static std::string textOf(const Volume& volume) {
    const auto& voxels = std::get<0>(volume.voxels);
    return {voxels.begin(), voxels.end()};
  }
};

/// The assumptions but for that of an NRRD file without a space.
inline std::vector<std::string> assumptionsBesideSpace(const Volume& volume) {
  std::vector<std::string> others = volume.assumptions;
  std::erase_if(others, [](const std::string& sentence) {
    return sentence.find("states no space") != std::string::npos;
  });
  return others;
}

/// One sentence that has all of these words, besides that of an NRRD file without a space.
inline void expectAssumes(const Volume& volume, const std::vector<std::string>& words) {
  const auto others = assumptionsBesideSpace(volume);
  ASSERT_EQ(others.size(), 1U);
  expectRefused(others[0], words);
}

}  // namespace lumen::convert
