// SPDX-License-Identifier: Apache-2.0
// The numbers of one data array of VTK's XML files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lumen {

enum class VtkForm : std::uint8_t { Ascii, Base64, Raw };

/// The packing of all binary data of a file, from its head.
struct VtkPacking {
  bool bigEndian = false;
  unsigned headerBytes = 4;  ///< of each size that stands before data: 4 or 8
  bool zlib = false;
};

struct VtkEncodedArray {
  std::string_view type;  ///< Int8, UInt8 ... Int64, UInt64, Float32, Float64
  VtkForm form = VtkForm::Ascii;
  std::string_view text;  ///< from the array's first byte on; may go on behind it unless ascii
  std::string where;      ///< begins messages: file, line and name
};

/// The `count` numbers of the array; those of 64 bits beyond 2^53 are rounded. Nothing is allocated
/// that the text cannot fill. Throws Error(InvalidInput) if the text holds other data.
std::vector<double> decodeVtkNumbers(const VtkEncodedArray& array, const VtkPacking& packing,
                                     std::uint64_t count);

/// The bytes of an array of characters up to the first zero; empty if it has more than `most`. Throws as above.
std::string decodeVtkText(const VtkEncodedArray& array, const VtkPacking& packing,
                          std::uint64_t most);

}  // namespace lumen
