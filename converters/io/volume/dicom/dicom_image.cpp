// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/dicom_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/io/volume/dicom/dicom_values.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

using formats::printable;

constexpr DicomTag kStorage = 0x00080016, kSeries = 0x0020000e, kModality = 0x00080060,
                   kDescription = 0x0008103e, kPosition = 0x00200032, kOrientation = 0x00200037,
                   kSamples = 0x00280002, kPhotometric = 0x00280004, kFrames = 0x00280008,
                   kRows = 0x00280010, kColumns = 0x00280011, kPixelSpacing = 0x00280030,
                   kBitsAllocated = 0x00280100, kBitsStored = 0x00280101, kHighBit = 0x00280102,
                   kSigned = 0x00280103, kPadding = 0x00280120, kPaddingLimit = 0x00280121,
                   kIntercept = 0x00281052, kSlope = 0x00281053, kDistance = 0x00180088,
                   kSegmentation = 0x00620001, kMostFraction = 0x0062000e, kSegment = 0x0062000b;
/// Functional groups that all frames share, and those of single frames.
constexpr DicomTag kShared = 0x52009229, kPerFrame = 0x52009230;

constexpr std::size_t kMaxFrames = 1 << 16;
// Rescaled values are stored as floats; GDCM counts them in integers where it can.
constexpr double kMaxScaling = 1e9;
constexpr double kUnitTolerance = 1e-3;  // directions have 6 digits and more
// Compressed pixels: what an encoder of constant images achieves, beside a floor for small images.
constexpr double kMaxExpansion = 1032, kAlwaysAllowed = 64 << 20;

/// Collects the needed values of a data set during the walk.
struct Content {
  DicomValues top, shared;
  std::vector<DicomValues> perFrame;
  DicomElement pixels;

  /// Destination of the value, or null if it is not needed.
  DicomValues* place(DicomTag tag, const DicomPlace& place) {
    const std::vector<DicomTag>& path = place.path;
    static constexpr std::array kTop = {
        kStorage,       kSeries,      kModality,     kDescription,  kPosition,    kOrientation,
        kSamples,       kPhotometric, kFrames,       kRows,         kColumns,     kPixelSpacing,
        kBitsAllocated, kBitsStored,  kHighBit,      kSigned,       kDistance,    kIntercept,
        kSlope,         kPadding,     kPaddingLimit, kSegmentation, kMostFraction};
    static constexpr std::array kGroup = {kPosition,  kOrientation, kPixelSpacing, kDistance,
                                          kIntercept, kSlope,       kSegment};
    const auto has = [&](const auto& tags) {
      return std::find(tags.begin(), tags.end(), tag) != tags.end();
    };
    const bool isPhase =
        std::any_of(kPhaseElements.begin(), kPhaseElements.end(),
                    [&](const DicomPhaseElement& element) { return element.tag == tag; });
    if (path.empty()) return has(kTop) || isPhase ? &top : nullptr;
    if (path.size() != 2 || !(has(kGroup) || isPhase)) return nullptr;
    if (path[0] == kShared) return &shared;
    const std::size_t item = place.items[0];
    if (path[0] != kPerFrame || item >= kMaxFrames) return nullptr;
    if (perFrame.size() <= item) perFrame.resize(item + 1);
    return &perFrame[item];
  }
};

DicomVisitor collectInto(Content& content, DicomBytes& bytes) {
  return [&](const DicomElement& element, const DicomPlace& place) {
    if (element.tag == kPixelData && place.path.empty()) {
      if (content.pixels.tag != 0) throw invalidInput("it has pixels twice; expected one image");
      content.pixels = element;
    }
    DicomValues* const values = content.place(element.tag, place);
    if (values == nullptr) return;
    addDicomValue(bytes, element, *values);
  };
}

void checkOrientation(const std::array<double, 6>& v) {
  const Eigen::Vector3d row(v[0], v[1], v[2]), column(v[3], v[4], v[5]);
  if (std::abs(row.norm() - 1) <= kUnitTolerance && std::abs(column.norm() - 1) <= kUnitTolerance &&
      std::abs(row.dot(column)) <= kUnitTolerance)
    return;
  throw invalidInput("its image orientation " + tagText(kOrientation) +
                     " is of no two orthogonal unit vectors, so it has no place in space");
}

DicomPlane readPlane(const DicomValues& values) {
  const DicomReader reader(values, false);
  DicomPlane plane;
  if (const auto v = reader.decimals<3>(kPosition, "image position"))
    plane.position = Eigen::Vector3d((*v)[0], (*v)[1], (*v)[2]);
  plane.orientation = reader.decimals<6>(kOrientation, "image orientation");
  if (plane.orientation) checkOrientation(*plane.orientation);
  plane.pixelSpacing = reader.decimals<2>(kPixelSpacing, "pixel spacing");
  plane.distance = reader.decimal(kDistance, "spacing between slices");
  plane.slope = reader.decimal(kSlope, "rescale slope");
  plane.intercept = reader.decimal(kIntercept, "rescale intercept");
  const double slope = plane.slope.value_or(1), intercept = plane.intercept.value_or(0);
  if (slope == 0 || std::abs(slope) > kMaxScaling || std::abs(intercept) > kMaxScaling)
    throw invalidInput("its values are rescaled by " + foundNumber(slope) + " and " +
                       foundNumber(intercept) + " " + tagText(kSlope) +
                       "; expected a slope other than 0, and both below 1e9");
  return plane;
}

/// Each value of `specific`, or of `general` where it states none.
DicomPlane joined(DicomPlane specific, const DicomPlane& general) {
  if (!specific.position) specific.position = general.position;
  if (!specific.orientation) specific.orientation = general.orientation;
  if (!specific.pixelSpacing) specific.pixelSpacing = general.pixelSpacing;
  if (!specific.distance) specific.distance = general.distance;
  if (!specific.slope) specific.slope = general.slope;
  if (!specific.intercept) specific.intercept = general.intercept;
  return specific;
}

void readFormat(const DicomReader& reader, DicomImage& image) {
  image.rows = reader.word(kRows, "the number of rows");
  image.columns = reader.word(kColumns, "the number of columns");
  if (image.rows == 0 || image.columns == 0)
    throw invalidInput("it has " + std::to_string(image.columns) + " x " +
                       std::to_string(image.rows) + " pixels; expected an image");
  image.samples = reader.word(kSamples, "the number of samples for each pixel", 1);
  image.photometric = reader.text(kPhotometric);
  const double frames = reader.decimal(kFrames, "number of frames").value_or(1);
  if (!(frames >= 1 && frames <= kMaxFrames && frames == std::floor(frames)))
    throw invalidInput("its number of frames " + tagText(kFrames) + " is " +
                       std::to_string(frames) + "; expected 1 to " + std::to_string(kMaxFrames));
  image.frames = static_cast<std::size_t>(frames);
  image.bitsAllocated = reader.word(kBitsAllocated, "the number of bits for a pixel");
  image.bitsStored = reader.word(kBitsStored, "the number of bits used", image.bitsAllocated);
  const std::size_t highBit = reader.word(kHighBit, "the highest bit", image.bitsStored - 1);
  image.isSigned = reader.word(kSigned, "the representation of pixels", 0) == 1;
  if (const auto padding = reader.level(kPadding, image.isSigned))
    image.padding = {*padding, reader.level(kPaddingLimit, image.isSigned).value_or(*padding)};
  const bool isBit = image.bitsAllocated == 1 && image.labels == DicomLabels::Binary;
  if (image.bitsAllocated != 8 && image.bitsAllocated != 16 && image.bitsAllocated != 32 && !isBit)
    throw unsupported("its pixels have " + std::to_string(image.bitsAllocated) +
                      " bits (0028,0100); expected 8, 16 or 32, or 1 in a segmentation");
  if (image.bitsStored < 1 || image.bitsStored > image.bitsAllocated)
    throw invalidInput("its pixels use " + std::to_string(image.bitsStored) + " of " +
                       std::to_string(image.bitsAllocated) + " bits; expected 1 to all of them");
  image.highBit = highBit;
  const bool isNative =
      image.packing == DicomPacking::Native || image.packing == DicomPacking::NativeBigEndian;
  if (highBit + 1 < image.bitsStored || highBit >= image.bitsAllocated ||
      (highBit + 1 != image.bitsStored && !isNative))
    throw unsupported("its highest bit " + tagText(kHighBit) + " is " + std::to_string(highBit) +
                      "; expected " + std::to_string(image.bitsStored - 1) +
                      ", one less than the bits used");
}

/// Refuses colour, which has no single number per pixel.
void checkGrey(const DicomImage& image) {
  const bool palette = image.photometric == "PALETTE COLOR";
  if (palette && image.labels == DicomLabels::Map && image.samples == 1) return;
  if (image.samples != 1 || palette)
    throw invalidInput("each pixel has " + std::to_string(palette ? 3 : image.samples) +
                       " components; expected one number");
  if (image.photometric != "MONOCHROME1" && image.photometric != "MONOCHROME2")
    throw unsupported("its photometric interpretation " + tagText(kPhotometric) + " is \"" +
                      printable(image.photometric) + "\"; expected MONOCHROME2 or MONOCHROME1");
}

/// Refuses pixel data that cannot hold the announced pixels.
void checkPixels(const DicomImage& image) {
  const std::size_t bytes = image.pixelBytes();
  const auto announced = static_cast<double>(bytes);
  const bool native =
      image.packing == DicomPacking::Native || image.packing == DicomPacking::NativeBigEndian;
  if (native == image.pixels.encapsulated)
    throw invalidInput(std::string("its pixels are ") + (native ? "" : "not ") +
                       "in fragments, but its transfer syntax " + image.transferSyntax +
                       (native ? " has plain ones" : " has compressed ones"));
  if (native && static_cast<double>(image.pixels.value.length) < announced)
    throw invalidInput("truncated: it announces " + std::to_string(image.columns) + " x " +
                       std::to_string(image.rows) + " x " + std::to_string(image.frames) +
                       " pixels, which have " + std::to_string(bytes) + " bytes, but holds " +
                       std::to_string(image.pixels.value.length));
  if (native) return;
  const std::size_t fragments = image.pixels.fragments.size();
  const bool hasTable = image.pixels.offsets.length == 4 * image.frames;
  if (fragments == 0 || (image.frames > 1 && fragments != image.frames && !hasTable) ||
      fragments < image.frames)
    throw invalidInput(
        "it has " + std::to_string(image.frames) + " frames, but " + std::to_string(fragments) +
        " fragments of compressed pixels; expected one for each frame, or a table of "
        "their offsets");
  double stored = 0;
  for (const DicomExtent& fragment : image.pixels.fragments)
    stored += static_cast<double>(fragment.length);
  if (announced > std::max(kAlwaysAllowed, kMaxExpansion * stored))
    throw invalidInput("truncated: it announces " + std::to_string(announced) +
                       " bytes of pixels, which cannot come out of " + std::to_string(stored));
}

void readLabels(const DicomReader& reader, DicomImage& image) {
  const std::string type = reader.text(kSegmentation);
  if (type.empty()) return;
  const std::array<std::pair<const char*, DicomLabels>, 3> types = {
      {{"BINARY", DicomLabels::Binary},
       {"FRACTIONAL", DicomLabels::Fractional},
       {"LABELMAP", DicomLabels::Map}}};
  for (const auto& [word, labels] : types)
    if (type == word) image.labels = labels;
  if (image.labels == DicomLabels::None)
    throw unsupported("its segmentation type " + tagText(kSegmentation) + " is \"" +
                      printable(type) + "\"; expected BINARY, FRACTIONAL or LABELMAP");
  image.mostFraction = reader.word(kMostFraction, "the maximum fractional value", 1);
}

DicomPhases phasesOf(const DicomValues& values, bool bigEndian, DicomPhases phases) {
  const DicomReader reader(values, bigEndian);
  for (std::size_t e = 0; e < kPhaseElements.size(); ++e) {
    const std::string value = reader.shown(kPhaseElements[e].tag, kPhaseElements[e].type);
    if (!value.empty()) phases[e] = value;
  }
  return phases;
}

void fillImage(DicomImage& image, const Content& content, const DicomTransfer& syntax) {
  const DicomReader reader(content.top, syntax.how.bigEndian);
  image.transferSyntax = syntax.uid;
  image.packing = syntax.packing;
  image.description = reader.text(kDescription);
  image.modality = reader.text(kModality);
  image.pixels = content.pixels;
  readLabels(reader, image);
  readFormat(reader, image);
  checkGrey(image);
  if (syntax.how.bigEndian && image.bitsAllocated == 8 && image.pixels.vr != std::array{'O', 'B'})
    throw unsupported("its pixels of 8 bits are in big-endian words; expected bytes");
  image.plane = joined(readPlane(content.top), readPlane(content.shared));
  const bool big = syntax.how.bigEndian;
  image.phases = phasesOf(content.shared, big, phasesOf(content.top, big, {}));
  image.segment = DicomReader(content.shared, big).word(kSegment, "the segment", 0);
  for (const DicomValues& values : content.perFrame) {
    image.perFrame.push_back(joined(readPlane(values), image.plane));
    image.framePhases.push_back(phasesOf(values, big, image.phases));
    image.frameSegments.push_back(
        DicomReader(values, big).word(kSegment, "the segment", image.segment));
  }
  if (!image.perFrame.empty() && image.perFrame.size() != image.frames)
    throw invalidInput("it has " + std::to_string(image.frames) + " frames, but groups for " +
                       std::to_string(image.perFrame.size()) + "; expected one for each");
  checkPixels(image);
}

/// Fills `scan` up to the first fault of the file; throws without the file's name.
void scanInto(DicomScan& scan, DicomBytes& bytes, const DicomBeginning& beginning) {
  const DicomMeta meta = readDicomMeta(bytes, beginning);
  scan.storage = meta.storage;
  if (meta.storage == kDicomDirectory) return;
  const DicomTransfer& syntax = findTransfer(meta.transferSyntax);
  if (syntax.isDeflated) bytes.inflateFrom(meta.end);
  Content content;
  const DicomVisitor collect = collectInto(content, bytes);
  walkDicom(bytes, meta.end, syntax.how, [&](const DicomElement& element, const DicomPlace& place) {
    collect(element, place);
    if (element.tag == kSeries && place.path.empty())
      scan.series = DicomReader(content.top, false).text(kSeries);
  });
  if (scan.storage.empty()) scan.storage = DicomReader(content.top, false).text(kStorage);
  if (content.pixels.tag == 0) return;
  DicomImage& image = scan.image.emplace();
  image.series = scan.series;
  if (syntax.isDeflated) image.deflatedFrom = meta.end;
  fillImage(image, content, syntax);
}

}  // namespace

DicomScan scanDicom(const InputFile& file) {
  DicomScan scan;
  scan.file = file;
  DicomBeginning beginning{.hasMark = true};
  try {
    DicomBytes bytes(file);
    beginning = readDicomBeginning(bytes);
    if (!beginning.isDicom) return scan;
    scanInto(scan, bytes, beginning);
    if (scan.image) scan.image->file = file;
  } catch (const Error& error) {
    scan.image.reset();
    // without the mark the format was a guess
    if (beginning.hasMark || !scan.series.empty())
      scan.fault = Error(error.kind(), file.path().string() + ": " + error.what());
  }
  return scan;
}

}  // namespace lumen::convert
