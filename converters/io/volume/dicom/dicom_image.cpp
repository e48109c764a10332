// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/dicom_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "converters/base/number_text.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

using formats::printable;

constexpr DicomTag kTransferSyntax = 0x00020010, kStorageClass = 0x00020002, kSeries = 0x0020000e,
                   kModality = 0x00080060, kDescription = 0x0008103e, kPosition = 0x00200032,
                   kOrientation = 0x00200037, kSamples = 0x00280002, kPhotometric = 0x00280004,
                   kFrames = 0x00280008, kRows = 0x00280010, kColumns = 0x00280011,
                   kPixelSpacing = 0x00280030, kBitsAllocated = 0x00280100,
                   kBitsStored = 0x00280101, kHighBit = 0x00280102, kSigned = 0x00280103,
                   kPadding = 0x00280120, kPaddingLimit = 0x00280121, kIntercept = 0x00281052,
                   kSlope = 0x00281053, kDistance = 0x00180088;
/// Functional groups that all frames share, and those of single frames.
constexpr DicomTag kShared = 0x52009229, kPerFrame = 0x52009230;

// A text is at most 64 characters long and a list of numbers a few hundred in the elements used.
constexpr std::uint64_t kMaxValue = 1 << 12;
constexpr std::size_t kMaxFrames = 1 << 16;
// Rescaled values are stored as floats; GDCM counts them in integers where it can.
constexpr double kMaxScaling = 1e9;
constexpr double kUnitTolerance = 1e-3;  // directions have 6 digits and more
// Compressed pixels: what an encoder of constant images achieves, beside a floor for small images.
constexpr double kMaxExpansion = 1032, kAlwaysAllowed = 64 << 20;

using Values = std::map<DicomTag, std::string>;

struct Syntax {
  const char* uid;
  DicomSyntax how;
  DicomPacking packing;
};
constexpr DicomSyntax kExplicit{.explicitVr = true, .bigEndian = false};
// clang-format off
constexpr std::array<Syntax, 12> kSyntaxes = {{
    {"1.2.840.10008.1.2", {.explicitVr = false, .bigEndian = false}, DicomPacking::Native},
    {"1.2.840.10008.1.2.1", kExplicit, DicomPacking::Native},
    {"1.2.840.10008.1.2.2", {.explicitVr = true, .bigEndian = true}, DicomPacking::NativeBigEndian},
    {"1.2.840.10008.1.2.4.50", kExplicit, DicomPacking::Jpeg},
    {"1.2.840.10008.1.2.4.51", kExplicit, DicomPacking::Jpeg},
    {"1.2.840.10008.1.2.4.57", kExplicit, DicomPacking::Jpeg},
    {"1.2.840.10008.1.2.4.70", kExplicit, DicomPacking::Jpeg},
    {"1.2.840.10008.1.2.4.80", kExplicit, DicomPacking::JpegLs},
    {"1.2.840.10008.1.2.4.81", kExplicit, DicomPacking::JpegLs},
    {"1.2.840.10008.1.2.4.90", kExplicit, DicomPacking::Jpeg2000},
    {"1.2.840.10008.1.2.4.91", kExplicit, DicomPacking::Jpeg2000},
    {"1.2.840.10008.1.2.5", kExplicit, DicomPacking::RunLength}}};
// clang-format on

/// Collects the needed values of a data set during the walk.
struct Content {
  Values top, shared;
  std::vector<Values> perFrame;
  DicomElement pixels;

  /// Destination of the value, or null if it is not needed.
  Values* place(DicomTag tag, std::span<const DicomTag> path, std::size_t item) {
    static constexpr std::array kTop = {
        kSeries,         kModality,     kDescription, kPosition,    kOrientation,  kSamples,
        kPhotometric,    kFrames,       kRows,        kColumns,     kPixelSpacing, kBitsAllocated,
        kBitsStored,     kHighBit,      kSigned,      kDistance,    kIntercept,    kSlope,
        kTransferSyntax, kStorageClass, kPadding,     kPaddingLimit};
    static constexpr std::array kGroup = {kPosition, kOrientation, kPixelSpacing,
                                          kDistance, kIntercept,   kSlope};
    const auto has = [&](const auto& tags) {
      return std::find(tags.begin(), tags.end(), tag) != tags.end();
    };
    const bool isPhase =
        std::any_of(kPhaseElements.begin(), kPhaseElements.end(),
                    [&](const DicomPhaseElement& element) { return element.tag == tag; });
    if (path.empty()) return has(kTop) || isPhase ? &top : nullptr;
    if (path.size() != 2 || !has(kGroup)) return nullptr;
    if (path[0] == kShared) return &shared;
    if (path[0] != kPerFrame || item >= kMaxFrames) return nullptr;
    if (perFrame.size() <= item) perFrame.resize(item + 1);
    return &perFrame[item];
  }
};

DicomVisitor collectInto(Content& content, DicomBytes& bytes) {
  return [&](const DicomElement& element, std::span<const DicomTag> path, std::size_t item) {
    if (element.tag == kPixelData && path.empty()) {
      if (content.pixels.tag != 0) throw invalidInput("it has pixels twice; expected one image");
      content.pixels = element;
    }
    Values* const values = content.place(element.tag, path, item);
    if (values == nullptr) return;
    if (element.value.length > kMaxValue)
      throw invalidInput(tagText(element.tag) + " has " + std::to_string(element.value.length) +
                         " bytes; expected a number or a short text");
    std::string text(element.value.length, '\0');
    bytes.read(element.value.at, std::as_writable_bytes(std::span(text)));
    if (!values->emplace(element.tag, std::move(text)).second)
      throw invalidInput(tagText(element.tag) + " occurs twice; expected one value");
  };
}

/// Reads numbers of one data set, with messages that name the element.
class DataSetReader {
public:
  DataSetReader(const Values& values, bool bigEndian) : m_values(values), m_bigEndian(bigEndian) {}

  [[nodiscard]] std::string text(DicomTag tag) const {
    const auto found = m_values.find(tag);
    return found == m_values.end() ? std::string() : trimmedText(found->second);
  }

  /// An unsigned number of two bytes.
  [[nodiscard]] std::size_t word(DicomTag tag, const char* name,
                                 std::optional<std::size_t> otherwise = std::nullopt) const {
    const auto found = m_values.find(tag);
    if (found == m_values.end() && otherwise) return *otherwise;
    if (found == m_values.end() || found->second.size() != 2)
      throw invalidInput(std::string(name) + " " + tagText(tag) +
                         (found == m_values.end() ? " is missing" : " is not of two bytes") +
                         "; expected one number");
    return number(found->second);
  }

  /// A stored value of two bytes; empty where the element is missing or has another length.
  [[nodiscard]] std::optional<double> level(DicomTag tag, bool isSigned) const {
    const auto found = m_values.find(tag);
    if (found == m_values.end() || found->second.size() != 2) return std::nullopt;
    const auto stored = static_cast<std::uint16_t>(number(found->second));
    return isSigned ? static_cast<double>(static_cast<std::int16_t>(stored))
                    : static_cast<double>(stored);
  }

  /// Decimal numbers; empty where the element is missing or empty.
  template <std::size_t N>
  [[nodiscard]] std::optional<std::array<double, N>> decimals(DicomTag tag,
                                                              const char* name) const {
    const std::string value = text(tag);
    if (value.empty()) return std::nullopt;
    const std::vector<double> numbers = parseNumbers(value);
    if (numbers.size() != N)
      throw invalidInput("its " + std::string(name) + " " + tagText(tag) + " is \"" +
                         printable(value) + "\"; expected " + std::to_string(N) +
                         (N == 1 ? " number" : " numbers"));
    std::array<double, N> result{};
    std::copy(numbers.begin(), numbers.end(), result.begin());
    return result;
  }
  [[nodiscard]] std::optional<double> decimal(DicomTag tag, const char* name) const {
    const auto value = decimals<1>(tag, name);
    return value ? std::optional((*value)[0]) : std::nullopt;
  }

private:
  [[nodiscard]] std::size_t number(const std::string& bytes) const {
    const auto byte = [&](std::size_t i) {
      return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i]));
    };
    return m_bigEndian ? byte(0) << 8U | byte(1) : byte(1) << 8U | byte(0);
  }

  const Values& m_values;
  bool m_bigEndian;
};

void checkOrientation(const std::array<double, 6>& v) {
  const Eigen::Vector3d row(v[0], v[1], v[2]), column(v[3], v[4], v[5]);
  if (std::abs(row.norm() - 1) <= kUnitTolerance && std::abs(column.norm() - 1) <= kUnitTolerance &&
      std::abs(row.dot(column)) <= kUnitTolerance)
    return;
  throw invalidInput("its image orientation " + tagText(kOrientation) +
                     " is of no two orthogonal unit vectors, so it has no place in space");
}

DicomPlane readPlane(const Values& values) {
  const DataSetReader reader(values, false);
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

void readFormat(const DataSetReader& reader, DicomImage& image) {
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
  if (image.bitsAllocated != 8 && image.bitsAllocated != 16 && image.bitsAllocated != 32)
    throw unsupported("its pixels have " + std::to_string(image.bitsAllocated) +
                      " bits; expected 8, 16 or 32");
  if (image.bitsStored < 1 || image.bitsStored > image.bitsAllocated)
    throw invalidInput("its pixels use " + std::to_string(image.bitsStored) + " of " +
                       std::to_string(image.bitsAllocated) + " bits; expected 1 to all of them");
  if (highBit != image.bitsStored - 1)
    throw unsupported("its highest bit " + tagText(kHighBit) + " is " + std::to_string(highBit) +
                      "; expected " + std::to_string(image.bitsStored - 1) +
                      ", one less than the bits used");
}

/// Refuses colour, which has no single number per pixel.
void checkGrey(const DicomImage& image) {
  const bool palette = image.photometric == "PALETTE COLOR";
  if (image.samples != 1 || palette)
    throw invalidInput("each pixel has " + std::to_string(palette ? 3 : image.samples) +
                       " components; expected one number");
  if (image.photometric != "MONOCHROME1" && image.photometric != "MONOCHROME2")
    throw unsupported("its photometric interpretation " + tagText(kPhotometric) + " is \"" +
                      printable(image.photometric) + "\"; expected MONOCHROME2 or MONOCHROME1");
}

/// Refuses pixel data that cannot hold the announced pixels.
void checkPixels(const DicomImage& image) {
  const auto announced = static_cast<double>(image.frameBytes() * image.frames);
  const bool native =
      image.packing == DicomPacking::Native || image.packing == DicomPacking::NativeBigEndian;
  if (native == image.pixels.encapsulated)
    throw invalidInput(std::string("its pixels are ") + (native ? "" : "not ") +
                       "in fragments, but its transfer syntax " + image.transferSyntax +
                       (native ? " has plain ones" : " has compressed ones"));
  if (native && static_cast<double>(image.pixels.value.length) < announced)
    throw invalidInput("truncated: it announces " + std::to_string(image.columns) + " x " +
                       std::to_string(image.rows) + " x " + std::to_string(image.frames) +
                       " pixels, which have " + std::to_string(image.frameBytes() * image.frames) +
                       " bytes, but holds " + std::to_string(image.pixels.value.length));
  if (native) return;
  const std::size_t fragments = image.pixels.fragments.size();
  if (fragments == 0 || (image.frames > 1 && fragments != image.frames))
    throw invalidInput("it has " + std::to_string(image.frames) + " frames, but " +
                       std::to_string(fragments) +
                       " fragments of compressed pixels; expected one for each frame");
  double stored = 0;
  for (const DicomExtent& fragment : image.pixels.fragments)
    stored += static_cast<double>(fragment.length);
  if (announced > std::max(kAlwaysAllowed, kMaxExpansion * stored))
    throw invalidInput("truncated: it announces " + std::to_string(announced) +
                       " bytes of pixels, which cannot come out of " + std::to_string(stored));
}

/// The beginning of a file.
struct Beginning {
  bool isDicom = false;
  std::uint64_t at = 0;  ///< offset of the first element
  bool hasMeta = false;  ///< group 2 comes first
  bool hasMark = false;  ///< "DICM" at byte 128
  bool explicitVr = true;
};

/// Old writers omit the mark and the meta information: such a file begins with an element of group
/// 2 or 8, little-endian.
Beginning readBeginning(DicomBytes& bytes) {
  constexpr std::uint64_t kMarkEnd = 132;
  std::array<std::byte, 4> mark{};
  if (bytes.size() >= kMarkEnd) bytes.read(kMarkEnd - mark.size(), mark);
  if (std::memcmp(mark.data(), "DICM", mark.size()) == 0) return {true, kMarkEnd, true, true, true};
  std::array<std::byte, 8> head{};
  if (bytes.size() < head.size()) return {};
  bytes.read(0, head);
  const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(head[i]); };
  const bool isGroup = (byte(0) == 2 || byte(0) == 8) && byte(1) == 0;
  if (!isGroup || byte(2) >= 0x20 || byte(3) != 0) return {};
  const std::array vr = {static_cast<char>(head[4]), static_cast<char>(head[5])};
  return {true, 0, byte(0) == 2, false, isRepresentation(vr)};
}

const Syntax& findSyntax(const std::string& uid) {
  const auto* const found = std::find_if(kSyntaxes.begin(), kSyntaxes.end(),
                                         [&](const Syntax& syntax) { return uid == syntax.uid; });
  if (found == kSyntaxes.end())
    throw unsupported("its transfer syntax is \"" + printable(uid) +
                      "\"; expected plain pixels, JPEG, JPEG-LS, JPEG 2000 or RLE");
  return *found;
}

void fillImage(DicomImage& image, const Content& content, const Syntax& syntax) {
  const DataSetReader reader(content.top, syntax.how.bigEndian);
  image.transferSyntax = syntax.uid;
  image.packing = syntax.packing;
  image.description = reader.text(kDescription);
  image.modality = reader.text(kModality);
  image.pixels = content.pixels;
  for (std::size_t e = 0; e < kPhaseElements.size(); ++e)
    image.phases[e] = reader.text(kPhaseElements[e].tag);
  readFormat(reader, image);
  checkGrey(image);
  if (syntax.how.bigEndian && image.bitsAllocated == 8 && image.pixels.vr != std::array{'O', 'B'})
    throw unsupported("its pixels of 8 bits are in big-endian words; expected bytes");
  image.plane = joined(readPlane(content.top), readPlane(content.shared));
  for (const Values& values : content.perFrame)
    image.perFrame.push_back(joined(readPlane(values), image.plane));
  if (!image.perFrame.empty() && image.perFrame.size() != image.frames)
    throw invalidInput("it has " + std::to_string(image.frames) + " frames, but groups for " +
                       std::to_string(image.perFrame.size()) + "; expected one for each");
  checkPixels(image);
}

/// The meta information's transfer syntax and storage class; the offset of the data set.
std::uint64_t readMeta(DicomBytes& bytes, const Beginning& beginning, std::string& syntax,
                       std::string& storage) {
  if (!beginning.hasMeta) {
    syntax = beginning.explicitVr ? "1.2.840.10008.1.2.1" : "1.2.840.10008.1.2";
    return beginning.at;
  }
  Content meta;
  const std::uint64_t end = walkDicomMeta(bytes, beginning.at, collectInto(meta, bytes));
  const DataSetReader reader(meta.top, false);
  syntax = reader.text(kTransferSyntax);
  storage = reader.text(kStorageClass);
  return end;
}

/// Fills `scan` up to the first fault of the file; throws without the file's name.
void scanInto(DicomScan& scan, DicomBytes& bytes, const Beginning& beginning) {
  std::string uid, storage;
  const std::uint64_t begin = readMeta(bytes, beginning, uid, storage);
  constexpr const char* kDirectory = "1.2.840.10008.1.3.10";
  if (storage == kDirectory) return;
  const Syntax& syntax = findSyntax(uid);
  Content content;
  const DicomVisitor collect = collectInto(content, bytes);
  walkDicom(bytes, begin, syntax.how,
            [&](const DicomElement& element, std::span<const DicomTag> path, std::size_t item) {
              collect(element, path, item);
              if (element.tag == kSeries && path.empty())
                scan.series = DataSetReader(content.top, false).text(kSeries);
            });
  if (content.pixels.tag == 0) return;
  DicomImage& image = scan.image.emplace();
  image.series = scan.series;
  fillImage(image, content, syntax);
}

}  // namespace

DicomScan scanDicom(const InputFile& file) {
  DicomScan scan;
  scan.file = file;
  Beginning beginning{.hasMark = true};
  try {
    DicomBytes bytes(file);
    beginning = readBeginning(bytes);
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
