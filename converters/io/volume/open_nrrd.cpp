// SPDX-License-Identifier: Apache-2.0
// NRRD of open_volume.h, after G. Kindlmann, "Definition of NRRD File Format" (Teem).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/volume/detached_data.h"
#include "converters/io/volume/image_header.h"
#include "converters/io/volume/text_header.h"
#include "converters/io/volume/volume_checks.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxDimension = 16;
constexpr std::int64_t kMaxInt = std::numeric_limits<int>::max();

/// Synonyms of field names, all in lower case, and the names kept here.
std::string fieldName(const std::string& name) {
  static const std::map<std::string, std::string> other = {{"datafile", "data file"},
                                                           {"lineskip", "line skip"},
                                                           {"byteskip", "byte skip"},
                                                           {"axismins", "axis mins"},
                                                           {"oldmin", "old min"},
                                                           {"oldmax", "old max"},
                                                           {"axismaxs", "axis maxs"},
                                                           {"centerings", "centers"},
                                                           {"spacedirections", "space directions"},
                                                           {"spaceorigin", "space origin"},
                                                           {"spaceunits", "space units"},
                                                           {"spacedimension", "space dimension"}};
  const auto found = other.find(name);
  return found == other.end() ? name : found->second;
}

void checkMagic(const fs::path& path, const std::string& line) {
  if (line.rfind("NRRD", 0) != 0)
    throw invalidInput(path.string() + ": is not an NRRD file: it does not begin with \"NRRD\"");
  static const std::array<std::string, 6> known = {"NRRD00.01", "NRRD0001", "NRRD0002",
                                                   "NRRD0003",  "NRRD0004", "NRRD0005"};
  if (std::find(known.begin(), known.end(), trimmed(line)) == known.end())
    throw unsupported(path.string() + ": is of the version " + quotedText(trimmed(line)) +
                      "; expected NRRD0001 to NRRD0005");
}

void setField(TextHeader& header, const std::string& line) {
  if (line[0] == '#') return;
  const auto colon = line.find(':');
  if (colon == std::string::npos)
    throw invalidInput(header.path().string() + ": its header has the line " + quotedText(line) +
                       "; expected a field, a colon and a value");
  if (line.compare(colon, 2, ":=") == 0) {
    header.notes.push_back(line);
    return;
  }
  const std::string name = fieldName(lowerCase(trimmed(line.substr(0, colon))));
  header.set(name, trimmed(line.substr(colon + 1)));
}

bool isList(const TextHeader& header) {
  return header.text("data file").rfind("LIST", 0) == 0;
}

/// Reads "field: value" lines up to an empty one; a list of files is followed by their names.
TextHeader readFields(const InputFile& file) {
  const fs::path& path = file.path();
  HeaderLines lines(file);
  TextHeader header(file);
  std::string line;
  (void)lines.next(line);
  checkMagic(path, line);
  while (!isList(header)) {
    if (!lines.next(line)) {
      if (header.has("data file")) return header;  // an empty line is not required
      throw invalidInput(path.string() + ": truncated: no empty line ends its NRRD header");
    }
    header.size = lines.size();
    if (trimmed(line).empty()) return header;
    setField(header, line);
  }
  while (lines.next(line))
    if (!trimmed(line).empty()) header.files.push_back(trimmed(line));
  return header;
}

PixelType pixelType(const TextHeader& header) {
  static const std::map<std::string, PixelType> types = {
      {"signed char", PixelType::Int8},
      {"int8", PixelType::Int8},
      {"int8_t", PixelType::Int8},
      {"uchar", PixelType::UInt8},
      {"unsigned char", PixelType::UInt8},
      {"uint8", PixelType::UInt8},
      {"uint8_t", PixelType::UInt8},
      {"short", PixelType::Int16},
      {"short int", PixelType::Int16},
      {"signed short", PixelType::Int16},
      {"signed short int", PixelType::Int16},
      {"int16", PixelType::Int16},
      {"int16_t", PixelType::Int16},
      {"ushort", PixelType::UInt16},
      {"unsigned short", PixelType::UInt16},
      {"unsigned short int", PixelType::UInt16},
      {"uint16", PixelType::UInt16},
      {"uint16_t", PixelType::UInt16},
      {"int", PixelType::Int32},
      {"signed int", PixelType::Int32},
      {"int32", PixelType::Int32},
      {"int32_t", PixelType::Int32},
      {"uint", PixelType::UInt32},
      {"unsigned int", PixelType::UInt32},
      {"uint32", PixelType::UInt32},
      {"uint32_t", PixelType::UInt32},
      {"longlong", PixelType::Int64},
      {"long long", PixelType::Int64},
      {"long long int", PixelType::Int64},
      {"signed long long", PixelType::Int64},
      {"signed long long int", PixelType::Int64},
      {"int64", PixelType::Int64},
      {"int64_t", PixelType::Int64},
      {"ulonglong", PixelType::UInt64},
      {"unsigned long long", PixelType::UInt64},
      {"unsigned long long int", PixelType::UInt64},
      {"uint64", PixelType::UInt64},
      {"uint64_t", PixelType::UInt64},
      {"float", PixelType::Float32},
      {"double", PixelType::Float64}};
  const auto found = types.find(lowerCase(header.required("type")));
  if (found == types.end())
    throw header.refusal("type", "integers of 8 to 64 bits, float or double");
  return found->second;
}

Packing readPacking(const TextHeader& header) {
  const std::string encoding = lowerCase(header.required("encoding"));
  if (encoding == "raw") return Packing::Raw;
  if (encoding == "gzip" || encoding == "gz") return Packing::Deflate;
  if (encoding == "ascii" || encoding == "text" || encoding == "txt") return Packing::Text;
  if (encoding == "hex") return Packing::Hex;
  throw unsupported(header.path().string() + ": its encoding is " +
                    quotedText(header.text("encoding")) +
                    "; expected raw, gzip, hex or text, as in \"unu save -f nrrd -e gzip\"");
}

bool isBigEndian(const TextHeader& header, const StoredVoxels& voxels) {
  const bool matters = sizeOf(voxels.type) > 1 && voxels.packing != Packing::Text;
  if (!header.has("endian") && !matters) return false;
  const std::string endian = lowerCase(header.required("endian"));
  if (endian != "little" && endian != "big") throw header.refusal("endian", "little or big");
  return endian == "big";
}

/// The files of a field "data file": a name; LIST and then names; or a pattern of names and the
/// numbers that it runs through. Lists and patterns may end with the number of `axes` that each
/// file holds, of `most`; a single file holds them all.
DetachedNames detachedNames(const TextHeader& header, std::int64_t most, std::int64_t& axes) {
  const std::string& text = header.text("data file");
  std::vector<std::string> words = splitWords(text);
  const auto integer = [&](const std::string& word) {
    const auto value = parseInteger(word);
    if (!value || std::abs(*value) > kMaxInt)
      throw header.refusal("data file", "a name, LIST, or a pattern and three whole numbers");
    return *value;
  };
  if (isList(header)) {
    if (words.size() == 2) axes = integer(words[1]);
    if (words[0] != "LIST" || words.size() > 2) throw header.refusal("data file", "LIST or LIST 2");
    return namesOfList(header.files);
  }
  // a name may hold spaces, and a per cent sign if no numbers follow it
  const bool pattern = words.size() >= 4 && text.find('%') != std::string::npos;
  if (!pattern) {
    axes = most;
    return namesOfList({text});
  }
  if (words.size() == 5) axes = integer(words[4]);
  if (words.size() > 5)
    throw header.refusal("data file", "a pattern without spaces and three or four whole numbers");
  const NumberRange range{integer(words[1]), integer(words[2]), integer(words[3])};
  if (range.step == 0) throw header.refusal("data file", "a step other than 0");
  return namesOfPattern(header.path(), words[0], range);
}

void setFiles(const TextHeader& header, const std::vector<std::int64_t>& sizes,
              const ReadVolumeOptions& options, StoredVoxels& voxels) {
  if (!header.has("data file")) {
    voxels.files = {header.file()};
    voxels.offset = header.size;
    return;
  }
  const auto dimension = static_cast<std::int64_t>(sizes.size());
  std::int64_t axes = dimension - 1;
  const DetachedNames names = detachedNames(header, dimension, axes);
  if (axes < 1 || axes > dimension)
    throw header.refusal("data file", "files of 1 to " + std::to_string(dimension) + " axes");
  std::uint64_t needed = 1;
  for (std::int64_t a = axes; a < dimension; ++a)
    needed *= static_cast<std::uint64_t>(sizes[static_cast<std::size_t>(a)]);
  const bool slabs = axes == dimension && names.count > 0 &&
                     static_cast<std::uint64_t>(sizes.back()) % names.count == 0;
  if (names.count != needed && !slabs)
    throw invalidInput(header.path().string() + ": its data file names " +
                       std::to_string(names.count) + " files; expected " + std::to_string(needed) +
                       " for its sizes " + quotedText(header.text("sizes")));
  for (const fs::path& file :
       detachedFiles(header.file(), names, options.allowedDetached, options.word))
    voxels.files.emplace_back(file);
}

/// Refuses a segmentation of several layers of which none is chosen, and names their segments.
void requireLayer(const TextHeader& header, const ReadVolumeOptions& options,
                  std::uint64_t volumes) {
  if (volumes < 2 || options.volumeIndex) return;
  std::map<std::string, std::string> layers, names;  // by the number of the segment
  for (const std::string& note : header.notes) {
    const std::size_t underscore = note.find('_'), equals = note.find(":=");
    if (!note.starts_with("Segment") || underscore > equals) continue;
    const std::string number = note.substr(0, underscore);
    const std::string key = note.substr(underscore + 1, equals - underscore - 1);
    if (key == "Layer") layers[number] = trimmed(note.substr(equals + 2));
    if (key == "Name") names[number] = trimmed(note.substr(equals + 2));
  }
  std::map<std::string, std::string> segments;  // by layer
  for (const auto& [number, layer] : layers)
    segments[layer] += (segments[layer].empty() ? "" : ", ") + names[number];
  if (segments.empty()) return;
  std::string text;
  for (const auto& [layer, of] : segments)
    text +=
        (text.empty() ? "" : "; ") + formats::printable(layer) + " with " + formats::printable(of);
  throw invalidInput(header.path().string() + ": holds " + std::to_string(volumes) +
                     " layers of segments (" + text + "); expected a choice of one with " +
                     options.word("volume-index"));
}

/// Reports that Teem's quantization is not undone.
void noteQuantization(const TextHeader& header, std::vector<std::string>& assumptions) {
  if (header.has("old min") || header.has("old max"))
    assumptions.emplace_back(
        "its values before quantization (old min, old max) are not restored: voxels have the "
        "values "
        "that are stored");
}

OpenVolume openNrrd(const InputFile& file, const ReadVolumeOptions& options,
                    const Progress& progress) {
  progress.check();
  const fs::path& path = file.path();
  const TextHeader fields = readFields(file);
  ImageHeader header;
  StoredVoxels& voxels = header.voxels;
  voxels.header = path;
  header.encoding = lowerCase(fields.required("encoding"));
  voxels.packing = readPacking(fields);
  voxels.type = pixelType(fields);
  voxels.bigEndian = isBigEndian(fields, voxels);
  const std::int64_t dimension = fields.integers("dimension", 1, 1, kMaxDimension)[0];
  const auto sizes = fields.integers("sizes", static_cast<std::size_t>(dimension), 1, kMaxInt);
  header.stated = nrrdGeometry(fields, sizes, options, header.assumptions);
  noteQuantization(fields, header.assumptions);
  std::uint64_t entries = 1;
  for (const std::int64_t size : sizes) entries *= static_cast<std::uint64_t>(size);
  requireLayer(fields, options, entries / header.stated.geometry.voxelCount());
  chooseVoxels(path, sizes, options, voxels, header.stated.geometry.voxelCount());
  if (header.stated.together > 0 && voxels.count > header.stated.geometry.voxelCount()) {
    const std::uint64_t volume = header.stated.geometry.voxelCount();
    voxels.together = header.stated.together;
    voxels.volumes = voxels.count / volume;
    voxels.volume = voxels.first / volume;
    voxels.first = 0;
  }
  voxels.lineSkip = static_cast<std::uint64_t>(
      fields.integer("line skip", 0, std::numeric_limits<std::int64_t>::max(), 0));
  // text has no bytes to count from its end
  const bool fromEnd = voxels.packing == Packing::Raw || voxels.packing == Packing::Deflate;
  constexpr std::int64_t kMostSkipped = std::int64_t{1} << 50;
  voxels.byteSkip = fields.integer("byte skip", fromEnd ? -kMostSkipped : 0, kMostSkipped, 0);
  setFiles(fields, sizes, options, voxels);
  return openImage(std::move(header), options, path);
}

}  // namespace

constinit const VolumeFormat VolumeFormat::Nrrd{openNrrd, encodeAsNrrd};

}  // namespace lumen::convert
