// SPDX-License-Identifier: Apache-2.0
// Reader of VTK's XML files of polygonal data (.vtp): VTK file formats, Kitware, section "XML file
// formats".
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "converters/io/vtk/vtk_poly_data.h"

namespace lumen {

/// The data of `text`, a whole file: all pieces merged, with the arrays of points and of cells that
/// `wanted` names and that all pieces have. Data may be ascii, binary (base64) or appended (raw or
/// base64), in either byte order, plain or packed by zlib. Memory is bounded by the size of the
/// text, packed data by zlib's maximum expansion. Throws Error(InvalidInput) with `name`, the line,
/// the finding and the expectation, and Error(Unsupported) for other compressors and data other
/// than polygons.
VtkPolyData parseVtkXml(std::string_view text, const std::string& name,
                        std::span<const std::string_view> wanted);

// The numbers of one data array of VTK's XML files.

enum class VtkForm : std::uint8_t { Ascii, Base64, Raw };

/// The packing of all binary data of a file, from its head.
struct VtkPacking {
  bool bigEndian = false;
  unsigned headerBytes = 4;  ///< bytes of each size that precedes data: 4 or 8
  bool zlib = false;
};

struct VtkEncodedArray {
  std::string_view type;  ///< Int8, UInt8 ... Int64, UInt64, Float32, Float64
  VtkForm form = VtkForm::Ascii;
  std::string_view text;  ///< array's text; may extend beyond it unless ascii
  std::string where;      ///< file, line and name: the beginning of messages
};

/// The `count` numbers of the array; those of 64 bits beyond 2^53 are rounded. Allocations never
/// exceed what the text can fill. Throws Error(InvalidInput) if the text holds other data.
std::vector<double> decodeVtkNumbers(const VtkEncodedArray& array, const VtkPacking& packing,
                                     std::uint64_t count);

/// The bytes of an array of characters up to the first zero; empty if it has more than `most`.
/// Throws Error(InvalidInput) if the text holds other data.
std::string decodeVtkText(const VtkEncodedArray& array, const VtkPacking& packing,
                          std::uint64_t most);

}  // namespace lumen
