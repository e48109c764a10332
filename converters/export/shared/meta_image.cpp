// SPDX-License-Identifier: Apache-2.0
// Declared in grid_files.h.
#include "converters/base/number_text.h"
#include "converters/export/shared/grid_files.h"

namespace lumen::convert {

std::string metaImageHeader(const Lattice& lattice, const std::string& type,
                            const std::string& raw) {
  const std::string spacing = exactText(lattice.spacing);
  const auto& [nx, ny, nz] = lattice.size;
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
         "CompressedData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = " +
         exactText(lattice.first[0]) + " " + exactText(lattice.first[1]) + " " +
         exactText(lattice.first[2]) + "\nCenterOfRotation = 0 0 0\nElementSpacing = " + spacing +
         " " + spacing + " " + spacing + "\nDimSize = " + std::to_string(nx) + " " +
         std::to_string(ny) + " " + std::to_string(nz) + "\nElementType = " + type +
         "\nElementDataFile = " + raw + "\n";
}

}  // namespace lumen::convert
