// SPDX-License-Identifier: Apache-2.0
// MetaImage of open_volume.h, after the MetaIO documentation of ITK.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/volume/detached_data.h"
#include "converters/io/volume/image_header.h"
#include "converters/io/volume/text_header.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr std::int64_t kMaxMetaInt = std::numeric_limits<int>::max();
constexpr double kUnstated = std::numeric_limits<double>::quiet_NaN();

// names of fields in this table and in messages
const std::string kSpacing = "ElementSpacing", kPixelSize = "ElementSize", kSizes = "DimSize";
const std::string kMatrix = "TransformMatrix", kOffset = "Offset", kType = "ElementType";
const std::string kDataFile = "ElementDataFile", kBigEndian = "ElementByteOrderMSB";
const std::string kChannels = "ElementNumberOfChannels", kUnits = "DistanceUnits";
const std::string kSlope = "ElementToIntensityFunctionSlope";
const std::string kIntercept = "ElementToIntensityFunctionOffset";
const std::string kAnatomical = "AnatomicalOrientation";

/// The canonical name of a field, whatever its case; synonyms map to one name.
std::string metaField(const std::string& name) {
  static const std::map<std::string, std::string> names = [] {
    std::map<std::string, std::string> all = {
        {"rotation", kMatrix}, {"orientation", kMatrix},   {"position", kOffset},
        {"origin", kOffset},   {"imageposition", kOffset}, {"binarydatabyteordermsb", kBigEndian}};
    for (const std::string& field :
         {kSpacing, kPixelSize, kSizes, kMatrix, kOffset, kType, kDataFile, kBigEndian, kChannels,
          kUnits, kSlope, kIntercept, kAnatomical, std::string("NDims"), std::string("BinaryData"),
          std::string("CompressedData"), std::string("CompressedDataSize"),
          std::string("HeaderSize"), std::string("ObjectType")})
      all[lowerCase(field)] = field;
    return all;
  }();
  const auto found = names.find(lowerCase(name));
  return found == names.end() ? lowerCase(name) : found->second;
}

/// "Key = value" lines; ElementDataFile is the last, except for the names of a list.
TextHeader readMetaFields(const InputFile& file) {
  HeaderLines lines(file);
  TextHeader header(file);
  for (std::string line; lines.next(line);) {
    const auto mark = line.find_first_of("=:");
    if (header.has(kDataFile)) {
      if (!trimmed(line).empty()) header.files.push_back(trimmed(line));
    } else if (mark != std::string::npos) {
      header.set(metaField(trimmed(line.substr(0, mark))), trimmed(line.substr(mark + 1)));
      header.size = lines.size();
      if (header.has(kDataFile) && header.text(kDataFile).rfind("LIST", 0) != 0) return header;
    } else if (!trimmed(line).empty()) {
      break;
    }
  }
  if (header.has(kDataFile)) return header;
  throw invalidInput(file.path().string() +
                     ": is not a MetaImage file: its header has no ElementDataFile line");
}

bool flag(const TextHeader& header, const std::string& field, bool absent) {
  if (!header.has(field)) return absent;
  const std::string value = lowerCase(header.text(field));
  if (value == "true" || value == "t" || value == "1") return true;
  if (value == "false" || value == "f" || value == "0") return false;
  throw header.refusal(field, "True or False");
}

PixelType metaType(const TextHeader& header) {
  static const std::map<std::string, PixelType> types = {
      {"MET_CHAR", PixelType::Int8},         {"MET_ASCII_CHAR", PixelType::Int8},
      {"MET_UCHAR", PixelType::UInt8},       {"MET_SHORT", PixelType::Int16},
      {"MET_USHORT", PixelType::UInt16},     {"MET_INT", PixelType::Int32},
      {"MET_UINT", PixelType::UInt32},       {"MET_LONG", PixelType::Int32},
      {"MET_ULONG", PixelType::UInt32},      {"MET_LONG_LONG", PixelType::Int64},
      {"MET_ULONG_LONG", PixelType::UInt64}, {"MET_FLOAT", PixelType::Float32},
      {"MET_DOUBLE", PixelType::Float64}};
  std::string name = header.required(kType);
  if (name.ends_with("_ARRAY")) name.resize(name.size() - 6);
  const auto found = types.find(name);
  if (found == types.end())
    throw header.refusal(kType, "integers of 8 to 64 bits, MET_FLOAT or MET_DOUBLE");
  return found->second;
}

/// The numbers of ElementSpacing, or those of ElementSize if it is absent.
std::vector<double> readSpacings(const TextHeader& header, std::size_t dimensions,
                                 const ReadVolumeOptions& options) {
  const std::string field = header.has(kSpacing) ? kSpacing : kPixelSize;
  std::vector<double> spacings = header.numbers(field, dimensions);
  for (int a = 0; a < 3 && !spacings.empty() && !options.spacing; ++a)
    checkStatedSpacing(header.path(), field, a + 1, spacings[static_cast<std::size_t>(a)],
                       options.word);
  return spacings;
}

/// The three letters of directions in LPS: the sides to which they run, or from which they come.
std::string sidesOf(const Eigen::Matrix3d& direction, bool isTo) {
  std::string sides;
  for (Eigen::Index a = 0; a < 3; ++a) {
    Eigen::Index row = 0;
    direction.col(a).cwiseAbs().maxCoeff(&row);
    sides += (direction(row, a) > 0) == isTo ? "LPS"[row] : "RAI"[row];
  }
  return sides;
}

/// MetaIO states by AnatomicalOrientation the sides to which axes run; ITK writes those from which they
/// come. The matrix counts: a sentence where the letters are neither.
void noteOrientation(const TextHeader& header, const VolumeGeometry& geometry,
                     std::vector<std::string>& assumptions) {
  const std::string& letters = header.text(kAnatomical);
  if (letters.size() != 3 || letters.find_first_not_of("RLAPSI") != std::string::npos) return;
  const std::string to = sidesOf(geometry.direction, true);
  if (letters == to || letters == sidesOf(geometry.direction, false)) return;
  assumptions.push_back("its AnatomicalOrientation is " + letters + ", but by " +
                        (header.has(kMatrix) ? "its TransformMatrix" : "MetaImage's default") +
                        ", which counts, its axes run to " + to);
}

StatedGeometry metaGeometry(const TextHeader& header, const std::vector<std::int64_t>& sizes,
                            const ReadVolumeOptions& options,
                            std::vector<std::string>& assumptions) {
  const std::size_t n = sizes.size();
  StatedGeometry stated;
  VolumeGeometry& g = stated.geometry;
  g.size = volumeSize(header.path(), sizes);
  const auto spacings = readSpacings(header, n, options);
  const auto offset = header.numbers(kOffset, n);
  const auto matrix = header.numbers(kMatrix, n * n);
  g.spacing.setConstant(kUnstated);
  for (std::size_t a = 0; a < 3; ++a) {
    const auto e = static_cast<Eigen::Index>(a);
    if (!spacings.empty()) g.spacing[e] = spacings[a];
    if (!offset.empty()) g.origin[e] = offset[a];
    for (std::size_t r = 0; r < 3 && !matrix.empty(); ++r)  // one axis after another
      g.direction(static_cast<Eigen::Index>(r), e) = matrix[n * a + r];
  }
  noteOrientation(header, g, assumptions);
  const std::string unit = header.text(kUnits);
  if (unit.empty() || unit == "?") return stated;
  stated.unit = millimetresPer(unit);
  if (!stated.unit && !options.unit)
    assumptions.push_back(
        "its DistanceUnits are " + quotedText(unit) +
        ", which are not known as a length, so they are taken to be mm; state the unit with " +
        options.word("unit"));
  return stated;
}

std::vector<std::int64_t> metaSizes(const TextHeader& header) {
  constexpr std::int64_t kMostDimensions = 10;
  const std::int64_t dimensions = header.integers("NDims", 1, 1, kMostDimensions)[0];
  auto sizes = header.integers(kSizes, static_cast<std::size_t>(dimensions), 1, kMaxMetaInt);
  if (dimensions < 3) (void)volumeSize(header.path(), sizes);
  return sizes;
}

std::uint64_t slicesOf(const std::vector<std::int64_t>& sizes, std::size_t axes) {
  std::uint64_t slices = 1;
  for (std::size_t a = axes; a < sizes.size(); ++a) slices *= static_cast<std::uint64_t>(sizes[a]);
  return slices;
}

/// "s%03d.raw", "s%03d.raw 1", "s%03d.raw 1 48", "s%03d.raw 1 48 1"; the name may hold spaces if
/// all three numbers follow.
DetachedNames metaPattern(const TextHeader& header, std::int64_t slices) {
  const std::string& text = header.text(kDataFile);
  std::vector<std::string> words = splitWords(text);
  if (words.size() > 4) {
    std::string name = text.substr(0, text.size() - words.back().size());
    for (std::size_t back = 2; back <= 4; ++back) {
      name = name.substr(0, name.find_last_not_of(" \t") + 1);
      if (back < 4) name.resize(name.size() - words[words.size() - back].size());
    }
    words = {name, words[words.size() - 3], words[words.size() - 2], words.back()};
  }
  std::vector<std::int64_t> numbers;
  for (std::size_t w = 1; w < words.size(); ++w) {
    const auto number = parseInteger(words[w]);
    if (!number || std::abs(*number) > kMaxMetaInt)
      throw header.refusal(kDataFile, "a pattern and up to three whole numbers: first, last, step");
    numbers.push_back(*number);
  }
  NumberRange range{1, slices, 1};
  if (!numbers.empty()) range = {numbers[0], numbers[0] + slices - 1, 1};
  if (numbers.size() > 1) range.last = numbers[1];
  if (numbers.size() > 2) range.step = numbers[2];
  if (range.step == 0) throw header.refusal(kDataFile, "a step other than 0");
  return namesOfPattern(header.path(), words[0], range);
}

/// A file name as stated, or with the ending of a compressed file if only that file exists.
std::string metaFile(const TextHeader& header, StoredVoxels& voxels) {
  const std::string& name = header.text(kDataFile);
  std::error_code ignored;
  const fs::path stated = header.path().parent_path() / name;
  if (header.file().isInMemory() || fs::exists(stated, ignored)) return name;
  for (const char* ending : {".gz", ".Z"})
    if (fs::exists(stated.string() + ending, ignored)) {
      voxels.packing = Packing::Deflate;
      return name + ending;
    }
  return name;
}

void setMetaFiles(const TextHeader& header, const std::vector<std::int64_t>& sizes,
                  const ReadVolumeOptions& options, StoredVoxels& voxels) {
  const std::string& text = header.required(kDataFile);
  if (text.empty()) throw header.refusal(kDataFile, "LOCAL or the name of a file");
  if (lowerCase(text) == "local") {
    voxels.files = {header.file()};
    voxels.offset = header.size;
    return;
  }
  DetachedNames names;
  std::size_t axes = sizes.size() - 1;
  const std::vector<std::string> words = splitWords(text);
  if (words[0] == "LIST") {
    if (words.size() > 1) {
      const auto stated = parseInteger(words[1]);
      if (words.size() > 2 || !stated || *stated < 1 ||
          *stated > static_cast<std::int64_t>(sizes.size()))
        throw header.refusal(kDataFile, "LIST and the number of axes of each file");
      axes = static_cast<std::size_t>(*stated);
    }
    names = namesOfList(header.files);
  } else if (text.find('%') != std::string::npos) {
    names = metaPattern(header, sizes.back());
  } else {
    axes = sizes.size();
    names = namesOfList({metaFile(header, voxels)});
  }
  if (names.count != slicesOf(sizes, axes))
    throw invalidInput(header.path().string() + ": its ElementDataFile names " +
                       std::to_string(names.count) + " files; expected " +
                       std::to_string(slicesOf(sizes, axes)) + " for its DimSize " +
                       quotedText(header.text(kSizes)));
  for (const fs::path& file :
       detachedFiles(header.file(), names, options.allowedDetached, options.word))
    voxels.files.emplace_back(file);
}

/// Packing of the voxels, and their offset in their files.
void setPacking(const TextHeader& header, ImageHeader& image) {
  StoredVoxels& voxels = image.voxels;
  const bool binary = flag(header, "BinaryData", true);
  const bool compressed = binary && flag(header, "CompressedData", false);
  voxels.packing = compressed ? Packing::Deflate : binary ? Packing::Raw : Packing::Text;
  image.encoding = compressed ? "compressed" : binary ? "raw" : "text";
  voxels.bigEndian = flag(header, kBigEndian, false);
  const std::int64_t most = std::int64_t{1} << 50;
  const std::int64_t size = header.integer("CompressedDataSize", 0, most, 0);
  if (compressed && size > 0) voxels.packedSize = static_cast<std::uint64_t>(size);
  const std::int64_t skip = header.integer("HeaderSize", binary && !compressed ? -1 : 0, most, 0);
  if (skip == -1) voxels.byteSkip = -1;
  if (skip > 0) voxels.offset = static_cast<std::uint64_t>(skip);
}

void noteScaling(const TextHeader& header, std::vector<std::string>& assumptions) {
  const auto slope = header.numbers(kSlope, 1), intercept = header.numbers(kIntercept, 1);
  if ((slope.empty() || slope[0] == 1) && (intercept.empty() || intercept[0] == 0)) return;
  assumptions.emplace_back(
      "its ElementToIntensityFunction is not applied: voxels have the values that are stored");
}

OpenVolume openMetaImage(const InputFile& file, const ReadVolumeOptions& options,
                         const Progress& progress) {
  progress.check();
  const fs::path& path = file.path();
  const TextHeader fields = readMetaFields(file);
  if (fields.has("ObjectType") && lowerCase(fields.text("ObjectType")) != "image")
    throw fields.refusal("ObjectType", "Image");
  const std::vector<std::int64_t> sizes = metaSizes(fields);
  ImageHeader header;
  header.voxels.header = path;
  const std::int64_t channels = fields.integer(kChannels, 1, kMaxMetaInt, 1);
  if (channels != 1)
    throw invalidInput(path.string() + ": each voxel has " + std::to_string(channels) +
                       " components; expected one number");
  header.stated = metaGeometry(fields, sizes, options, header.assumptions);
  header.voxels.type = metaType(fields);
  chooseVoxels(path, sizes, options, header.voxels, header.stated.geometry.voxelCount());
  noteScaling(fields, header.assumptions);
  setPacking(fields, header);
  const std::uint64_t stated = header.voxels.offset;
  setMetaFiles(fields, sizes, options, header.voxels);
  if (stated > 0 && stated < header.voxels.offset)
    throw fields.refusal("HeaderSize", "at least the " + std::to_string(header.voxels.offset) +
                                           " bytes of the header");
  if (stated > 0) header.voxels.offset = stated;
  if (header.voxels.files.size() > 1) header.voxels.packedSize.reset();  // the sum of all files
  return openImage(std::move(header), options, path);
}

}  // namespace

constinit const VolumeFormat VolumeFormat::MetaImage{openMetaImage, encodeAsMetaImage};

}  // namespace lumen::convert
