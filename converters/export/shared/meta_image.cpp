// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/meta_image.h"

#include <array>
#include <cstdio>

namespace lumen::convert {

namespace {

/// Each double's shortest text that reads back as the same.
std::string exactNumber(double value) {
  std::array<char, 32> text{};
  for (int digits = 9; digits <= 17; ++digits) {
    std::snprintf(text.data(), text.size(), "%.*g", digits, value);
    if (std::stod(text.data()) == value) break;
  }
  return text.data();
}

}  // namespace

std::string metaImageHeader(const Lattice& lattice, const std::string& type,
                            const std::string& raw) {
  const std::string spacing = exactNumber(lattice.spacing);
  const auto& [nx, ny, nz] = lattice.size;
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
         "CompressedData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = " +
         exactNumber(lattice.first[0]) + " " + exactNumber(lattice.first[1]) + " " +
         exactNumber(lattice.first[2]) + "\nCenterOfRotation = 0 0 0\nElementSpacing = " + spacing +
         " " + spacing + " " + spacing + "\nDimSize = " + std::to_string(nx) + " " +
         std::to_string(ny) + " " + std::to_string(nz) + "\nElementType = " + type +
         "\nElementDataFile = " + raw + "\n";
}

}  // namespace lumen::convert
