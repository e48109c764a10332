// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/dicom_tree.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "converters/base/error.h"
#include "converters/io/volume/dicom/dicom_file.h"

namespace lumen::convert {
namespace {

constexpr std::uint64_t kShort = 1 << 12;

DicomItem& itemAt(DicomItem& top, const DicomPlace& place) {
  DicomItem* item = &top;
  for (std::size_t n = 0; n < place.path.size(); ++n) {
    std::vector<DicomItem>& items = item->sequences[place.path[n]];
    if (items.size() <= place.items[n]) items.resize(place.items[n] + 1);
    item = &items[place.items[n]];
  }
  return *item;
}

/// The meaning of the code in the first item of a sequence.
std::string meaningIn(const DicomItem& item, DicomTag sequence) {
  constexpr DicomTag kMeaning = 0x00080104;
  const std::vector<DicomItem>& codes = item.items(sequence);
  return codes.empty() ? std::string() : codes[0].text(kMeaning);
}

std::vector<DicomSegment> segmentsIn(const DicomTree& tree) {
  constexpr DicomTag kSegments = 0x00620002, kNumber = 0x00620004, kLabel = 0x00620005,
                     kType = 0x0062000f;
  std::vector<DicomSegment> segments;
  for (const DicomItem& item : tree.top.items(kSegments)) {
    const DicomReader reader(item.values, tree.isBigEndian);
    segments.push_back({reader.word(kNumber, "the segment's number", 0), item.text(kLabel),
                        meaningIn(item, kType)});
  }
  return segments;
}

std::vector<DicomSegment> structuresIn(const DicomTree& tree) {
  constexpr DicomTag kStructures = 0x30060020, kNumber = 0x30060022, kName = 0x30060026,
                     kObservations = 0x30060080, kOf = 0x30060084, kCode = 0x30060086;
  std::map<std::string, std::string> types;
  for (const DicomItem& item : tree.top.items(kObservations))
    types[item.text(kOf)] = meaningIn(item, kCode);
  std::vector<DicomSegment> structures;
  std::vector<std::size_t> numbers;
  for (const DicomItem& item : tree.top.items(kStructures)) {
    const std::vector<double> number = parseNumbers(item.text(kNumber));
    numbers.push_back(number.size() == 1 && number[0] >= 1 && number[0] <= kMostLabel
                          ? static_cast<std::size_t>(number[0])
                          : 0);
    structures.push_back({0, item.text(kName), types[item.text(kNumber)]});
  }
  std::vector<std::size_t> sorted = numbers;
  std::sort(sorted.begin(), sorted.end());
  const bool areLabels = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end() &&
                         !sorted.empty() && sorted[0] > 0;
  for (std::size_t n = 0; n < structures.size(); ++n)
    structures[n].number = areLabels ? numbers[n] : n + 1;
  return structures;
}

}  // namespace

const std::vector<DicomItem>& DicomItem::items(DicomTag sequence) const {
  static const std::vector<DicomItem> kNone;
  const auto found = sequences.find(sequence);
  return found == sequences.end() ? kNone : found->second;
}

std::string DicomItem::text(DicomTag tag) const {
  const auto found = values.find(tag);
  return found == values.end() ? std::string() : trimmedText(found->second);
}

DicomTree readDicomTree(const InputFile& file, const std::vector<DicomTag>& sequences) {
  DicomTree tree;
  try {
    DicomBytes bytes(file);
    const DicomBeginning beginning = readDicomBeginning(bytes);
    tree.isDicom = beginning.isDicom;
    if (!tree.isDicom) return tree;
    const DicomMeta meta = readDicomMeta(bytes, beginning);
    tree.storage = meta.storage;
    const DicomTransfer& transfer = findTransfer(meta.transferSyntax);
    tree.isBigEndian = transfer.how.bigEndian;
    if (transfer.isDeflated) bytes.inflateFrom(meta.end);
    walkDicom(
        bytes, meta.end, transfer.how, [&](const DicomElement& element, const DicomPlace& place) {
          const bool isWanted =
              place.path.empty()
                  ? element.value.length <= kShort && element.tag != kPixelData
                  : std::find(sequences.begin(), sequences.end(), place.path[0]) != sequences.end();
          if (!isWanted || element.encapsulated) return;
          std::string text(element.value.length, '\0');
          bytes.read(element.value.at, std::as_writable_bytes(std::span(text)));
          itemAt(tree.top, place).values[element.tag] = std::move(text);
        });
  } catch (const Error& error) {
    throw Error(error.kind(), file.path().string() + ": " + error.what());
  }
  constexpr DicomTag kStorage = 0x00080016;  // of files without meta information
  if (tree.storage.empty()) tree.storage = tree.top.text(kStorage);
  return tree;
}

std::vector<DicomSegment> dicomSegments(const InputFile& file) {
  try {
    const DicomTree tree = readDicomTree(file, {0x00620002, 0x30060020, 0x30060080});
    return tree.storage == kDicomStructures ? structuresIn(tree) : segmentsIn(tree);
  } catch (const Error&) {
    return {};
  }
}

}  // namespace lumen::convert
