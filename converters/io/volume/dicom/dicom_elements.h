// SPDX-License-Identifier: Apache-2.0
// The structure of a DICOM file (DICOM PS3.5, PS3.10), walked strictly: every length must lie
// within its container. No library sees a file before this walk has accepted it: GDCM's reader
// asserts, allocates and guesses where a data set is damaged.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <istream>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "converters/base/input_file.h"

namespace lumen::convert {

/// Group in the upper half, element in the lower one.
using DicomTag = std::uint32_t;
inline constexpr DicomTag kPixelData = 0x7fe00010;

/// Random access to a file's numbers and bytes.
class DicomBytes {
public:
  /// Throws Error(InvalidInput), without the file's name, if `file` cannot be opened.
  explicit DicomBytes(const InputFile& file);
  [[nodiscard]] std::uint64_t size() const { return m_size; }
  /// Fills `to`, which must lie within the file.
  void read(std::uint64_t at, std::span<std::byte> to);
  /// Replaces all bytes from `at` on by what they unpack to (deflate, RFC 1951). Throws
  /// Error(InvalidInput) for a stream that is damaged, or unpacks to more than 4 GB.
  void inflateFrom(std::uint64_t at);

private:
  void readAt(std::uint64_t at, std::span<std::byte> to);

  std::unique_ptr<std::istream> m_file;
  std::uint64_t m_size = 0, m_windowAt = 0;
  std::vector<std::byte> m_window;  ///< all bytes, if they were unpacked
};

struct DicomExtent {
  std::uint64_t at = 0, length = 0;
};

struct DicomElement {
  DicomTag tag = 0;
  std::array<char, 2> vr{};  ///< value representation; "??" where the syntax leaves it out
  DicomExtent value;
  bool encapsulated = false;           ///< pixels are in `fragments`, not in `value`
  std::vector<DicomExtent> fragments;  ///< without the table of offsets
  DicomExtent offsets;                 ///< the table, of four bytes each; may be empty
};

/// Encoding of a data set.
struct DicomSyntax {
  bool explicitVr = true, bigEndian = false;
};

/// Place of an element: the sequences around it, outermost first, and the number of the item in each,
/// from 0.
struct DicomPlace {
  std::vector<DicomTag> path;
  std::vector<std::size_t> items;
};

/// Called for each element that is not a sequence.
using DicomVisitor = std::function<void(const DicomElement&, const DicomPlace&)>;

/// Walks the file's meta information, group 2, from byte `at`; returns the byte after it. Throws as
/// walkDicom() does.
std::uint64_t walkDicomMeta(DicomBytes& bytes, std::uint64_t at, const DicomVisitor& visit);

/// Walks the data set from byte `at` to the end of the file. Throws Error(InvalidInput), naming a
/// byte, for a structure that is damaged or deeper than 16 sequences; the message does not name the
/// file.
void walkDicom(DicomBytes& bytes, std::uint64_t at, DicomSyntax syntax, const DicomVisitor& visit);

/// True if `vr` is a value representation of DICOM.
bool isRepresentation(const std::array<char, 2>& vr);

/// The tag as text, "(0028,0010)".
std::string tagText(DicomTag tag);

/// A text without the spaces around it and the zeros behind it.
std::string trimmedText(std::string text);

/// The numbers of "0.5\0.25 "; empty if one of them is malformed.
std::vector<double> parseNumbers(const std::string& text);

}  // namespace lumen::convert
