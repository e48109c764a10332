// SPDX-License-Identifier: Apache-2.0
// DICOM files made by hand: synthetic voxels, explicit little-endian.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "fixtures.h"

namespace lumen::convert {

/// One slice of 4 x 3 pixels; pixel (i, j) holds first + i + 4 j.
struct DicomSlice {
  std::string series = "1.2.3.1", description = "Angio", photometric = "MONOCHROME2";
  std::string position = "0\\0\\0", orientation = "1\\0\\0\\0\\1\\0", spacing = "0.5\\0.25";
  std::string slope = "1", intercept = "0";
  int number = 1, first = 0, columns = 4, rows = 3, samples = 1, frames = 1;
  std::string frameSpacing{};
  int bits = 16, bitsUsed = 16, highBit = -1;  ///< highBit -1: one less than bitsUsed
  std::string syntax = "1.2.840.10008.1.2.1";  ///< UID
  std::string before{}, beforePixels{};        ///< elements, before group 0020 and before pixels
  std::string pixelElement{};                  ///< instead of the plain one

  [[nodiscard]] std::string bytes() const {
    const std::string instance = series + ".9." + std::to_string(number);
    // a CT image, or a multi-frame secondary capture of 16-bit words
    const std::string storage =
        frames == 1 ? "1.2.840.10008.5.1.4.1.1.2" : "1.2.840.10008.5.1.4.1.1.7.3";
    const std::string meta =
        uid(2, 2, storage) + uid(2, 3, instance) + uid(2, 0x10, syntax) + uid(2, 0x12, "1.2.3");
    std::string data = uid(8, 0x16, storage) + uid(8, 0x18, instance) + text(8, 0x60, "CS", "CT") +
                       text(8, 0x103e, "LO", description) +
                       (frameSpacing.empty() ? "" : text(0x18, 0x88, "DS", frameSpacing)) + before +
                       uid(0x20, 0xd, "1.2.3") + uid(0x20, 0xe, series) +
                       text(0x20, 0x13, "IS", std::to_string(number));
    if (!position.empty()) data += text(0x20, 0x32, "DS", position);
    if (!orientation.empty()) data += text(0x20, 0x37, "DS", orientation);
    data += number16(0x28, 2, samples) + text(0x28, 4, "CS", photometric);
    if (samples > 1) data += number16(0x28, 6, 0);
    if (frames > 1) data += text(0x28, 8, "IS", std::to_string(frames));
    data += number16(0x28, 0x10, rows) + number16(0x28, 0x11, columns) +
            (spacing == "none" ? "" : text(0x28, 0x30, "DS", spacing)) +
            number16(0x28, 0x100, samples > 1 ? 8 : bits) +
            number16(0x28, 0x101, samples > 1 ? 8 : bitsUsed) +
            number16(0x28, 0x102,
                     samples > 1   ? 7
                     : highBit < 0 ? bitsUsed - 1
                                   : highBit) +
            number16(0x28, 0x103, 0) + text(0x28, 0x1052, "DS", intercept) +
            text(0x28, 0x1053, "DS", slope) + beforePixels +
            (pixelElement.empty() ? pixels() : pixelElement);
    return std::string(128, '\0') + "DICM" + tag(2, 0) + "UL" + raw<std::uint16_t>(4) +
           raw(static_cast<std::uint32_t>(meta.size())) + meta + data;
  }

  template <class T>
  static std::string raw(T value) {
    return convert::bytes<T>({value});
  }
  static std::string tag(int group, int element) {
    return raw(static_cast<std::uint16_t>(group)) + raw(static_cast<std::uint16_t>(element));
  }
  static std::string text(int group, int element, const char* type, std::string value,
                          char pad = ' ') {
    if (value.size() % 2 != 0) value += pad;
    return tag(group, element) + type + raw(static_cast<std::uint16_t>(value.size())) + value;
  }
  static std::string uid(int group, int element, const std::string& value) {
    return text(group, element, "UI", value, '\0');
  }
  static std::string number16(int group, int element, int value) {
    return tag(group, element) + "US" + raw<std::uint16_t>(2) +
           raw(static_cast<std::uint16_t>(value));
  }
  [[nodiscard]] std::string pixels() const {
    std::string values;
    for (int n = 0; n < rows * columns * frames; ++n)
      values += samples > 1 ? std::string(static_cast<std::size_t>(samples), static_cast<char>(n))
                            : raw(static_cast<std::uint16_t>(first + n));
    return tag(0x7fe0, 0x10) + "OW" + raw<std::uint16_t>(0) +
           raw(static_cast<std::uint32_t>(values.size())) + values;
  }
  /// A sequence with these items, without lengths.
  static std::string openSequence(int group, int element, const std::vector<std::string>& items) {
    std::string all = tag(group, element) + "SQ" + raw<std::uint16_t>(0) + raw(0xffffffffU);
    for (const std::string& item : items)
      all += tag(0xfffe, 0xe000) + raw(0xffffffffU) + item + tag(0xfffe, 0xe00d) + raw(0U);
    return all + tag(0xfffe, 0xe0dd) + raw(0U);
  }
  /// Compressed pixels, after an empty table of offsets.
  static std::string fragments(const std::vector<std::string>& streams) {
    std::string all = tag(0x7fe0, 0x10) + "OB" + raw<std::uint16_t>(0) + raw(0xffffffffU) +
                      tag(0xfffe, 0xe000) + raw(0U);
    for (const std::string& stream : streams)
      all += tag(0xfffe, 0xe000) + raw(static_cast<std::uint32_t>(stream.size())) + stream;
    return all + tag(0xfffe, 0xe0dd) + raw(0U);
  }
};

class DicomTest : public FileTest {
protected:
  /// `count` slices 2 mm apart along z, from z = 10; the file names run against the positions.
  void writeSeries(const std::string& prefix, DicomSlice slice, int count) const {
    for (int n = 0; n < count; ++n) {
      slice.number = n + 1;
      slice.first = 100 * n;
      slice.position = "-5\\7\\" + std::to_string(10 + 2 * n);
      write(prefix + std::to_string(90 - n) + ".dcm", slice.bytes());
    }
  }
  [[nodiscard]] std::filesystem::path directory() const { return path("").parent_path(); }
};

}  // namespace lumen::convert
