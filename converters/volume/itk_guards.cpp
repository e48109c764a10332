// SPDX-License-Identifier: Apache-2.0
#include "converters/volume/itk_guards.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <vector>

#include <zlib.h>

#include "converters/common/error.h"
#include "converters/common/text.h"
#include "converters/volume/volume_checks.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxHeader = 1 << 20;

struct TextHeader {
  std::map<std::string, std::string> field;  ///< keys in lower case
  std::size_t size = 0;                      ///< bytes up to the data
  [[nodiscard]] std::string get(const std::string& key) const {
    const auto found = field.find(key);
    return found == field.end() ? std::string() : found->second;
  }
};

std::vector<double> numbers(const std::string& text) {
  std::vector<double> values;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) {
    char* end = nullptr;
    values.push_back(std::strtod(word.c_str(), &end));
    if (end == word.c_str()) values.back() = std::nan("");
  }
  return values;
}

/// The product of positive sizes; throws for others.
double voxelCount(const fs::path& path, const std::string& field, const std::string& sizes) {
  double result = 1;
  for (const double v : numbers(sizes)) {
    if (!(v >= 1))
      throw invalidInput(path.string() + ": its " + field + " are \"" + sizes +
                         "\"; expected positive counts of voxels");
    result *= v;
  }
  return result;
}

std::ifstream openFile(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw invalidInput(path.string() + ": cannot be opened");
  return stream;
}

/// Inflates the zlib or gzip stream at `offset` to nowhere: `needed` bytes must come out of it, and
/// its checksum must hold.
void checkDeflated(const fs::path& path, std::size_t offset, double needed,
                   const Progress& progress) {
  auto file = openFile(path);
  file.seekg(static_cast<std::streamoff>(offset));
  std::vector<unsigned char> in(1 << 18), out(1 << 20);
  z_stream stream{};
  constexpr int kWindowAndAnyHeader = 15 + 32;
  if (inflateInit2(&stream, kWindowAndAnyHeader) != Z_OK) throw failed("zlib does not start");
  const std::unique_ptr<z_stream, int (*)(z_streamp)> end(&stream, inflateEnd);
  double got = 0;
  int state = Z_OK;
  while (state == Z_OK) {
    progress.check();
    if (stream.avail_in == 0) {
      file.read(reinterpret_cast<char*>(in.data()), static_cast<std::streamsize>(in.size()));
      stream.next_in = in.data();
      stream.avail_in = static_cast<unsigned>(file.gcount());
      if (stream.avail_in == 0) break;
    }
    stream.next_out = out.data();
    stream.avail_out = static_cast<unsigned>(out.size());
    state = inflate(&stream, Z_NO_FLUSH);
    got += static_cast<double>(out.size() - stream.avail_out);
  }
  if (state == Z_STREAM_END && got >= needed) return;
  throw invalidInput(path.string() + ": its compressed voxels are truncated or damaged: " +
                     numberText(got) + " of " + numberText(needed) + " bytes come out");
}

/// Unchecked: deflated, from a place that is not known here.
enum class Packing { None, Deflate, Unchecked };

/// Checks the data of a header at `path`: in the same file after `offset` bytes, or in a file of
/// its own.
void checkData(const fs::path& path, const std::string& dataFile, std::size_t offset, double needed,
               Packing packing, const Progress& progress) {
  // lists and patterns of files are left to the reader
  if (dataFile.find_first_of("% ") != std::string::npos || lowerCase(dataFile) == "list") return;
  const fs::path data = dataFile.empty() ? path : path.parent_path() / dataFile;
  std::error_code error;
  const auto size = fs::file_size(data, error);
  if (error)
    throw invalidInput(path.string() + ": its voxels are in " + data.string() +
                       ", which cannot be read (" + error.message() + ")");
  const std::size_t start = dataFile.empty() ? offset : 0;
  checkRoom(data, needed, static_cast<double>(size) - static_cast<double>(start),
            packing != Packing::None);
  if (packing == Packing::Deflate) checkDeflated(data, start, needed, progress);
}

/// "Key = value" lines; ElementDataFile is the last.
TextHeader readMetaHeader(const fs::path& path) {
  auto stream = openFile(path);
  TextHeader header;
  for (std::string line; header.size < kMaxHeader && std::getline(stream, line);) {
    header.size += line.size() + 1;
    const auto equals = line.find('=');
    if (equals == std::string::npos) break;
    const std::string key = lowerCase(trimmed(line.substr(0, equals)));
    header.field[key] = trimmed(line.substr(equals + 1));
    if (key == "elementdatafile") return header;
  }
  throw invalidInput(path.string() +
                     ": is not a MetaImage file: its header has no ElementDataFile line");
}

/// Bytes of a MetaImage element; 0 for a name that is not known.
double metaBytes(const std::string& type) {
  static const std::map<std::string, double> size{
      {"MET_CHAR", 1},  {"MET_UCHAR", 1},  {"MET_SHORT", 2},     {"MET_USHORT", 2},
      {"MET_INT", 4},   {"MET_UINT", 4},   {"MET_LONG", 4},      {"MET_ULONG", 4},
      {"MET_FLOAT", 4}, {"MET_DOUBLE", 8}, {"MET_LONG_LONG", 8}, {"MET_ULONG_LONG", 8}};
  const auto found = size.find(type);
  return found == size.end() ? 0 : found->second;
}

/// "field: value" lines up to an empty one (Teem, definition of the NRRD file format).
TextHeader readNrrdHeader(const fs::path& path) {
  auto stream = openFile(path);
  TextHeader header;
  std::string line;
  if (!std::getline(stream, line) || line.rfind("NRRD", 0) != 0)
    throw invalidInput(path.string() + ": is not an NRRD file: it does not begin with \"NRRD\"");
  header.size = line.size() + 1;
  while (header.size < kMaxHeader && std::getline(stream, line)) {
    header.size += line.size() + 1;
    if (trimmed(line).empty()) return header;
    const auto colon = line.find(':');
    if (line[0] == '#' || colon == std::string::npos) continue;
    if (colon + 1 < line.size() && line[colon + 1] == '=') continue;  // a key/value pair
    header.field[lowerCase(trimmed(line.substr(0, colon)))] = trimmed(line.substr(colon + 1));
  }
  const bool detached = header.field.contains("data file") || header.field.contains("datafile");
  if (detached && header.size < kMaxHeader) return header;  // may do without an empty line
  throw invalidInput(path.string() + ": truncated: no empty line ends its NRRD header");
}

/// Bytes of an NRRD sample, by the names that the format defines; 0 for another.
double nrrdBytes(const std::string& type) {
  static const std::map<double, std::vector<std::string>> names{
      {1, {"signed char", "int8", "int8_t", "uchar", "unsigned char", "uint8", "uint8_t"}},
      {2,
       {"short", "short int", "signed short", "signed short int", "int16", "int16_t", "ushort",
        "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
      {4,
       {"int", "signed int", "int32", "int32_t", "uint", "unsigned int", "uint32", "uint32_t",
        "float"}},
      {8,
       {"longlong", "long long", "long long int", "signed long long", "signed long long int",
        "int64", "int64_t", "ulonglong", "unsigned long long", "unsigned long long int", "uint64",
        "uint64_t", "double"}}};
  for (const auto& [size, list] : names)
    if (std::find(list.begin(), list.end(), type) != list.end()) return size;
  return 0;
}

/// Lengths of the vectors in "(1,0,0) (0,1,0) none (0,0,1)"; "none" has no length.
std::vector<double> vectorLengths(std::string text) {
  std::vector<double> lengths;
  std::replace(text.begin(), text.end(), ',', ' ');
  for (auto open = text.find('('); open != std::string::npos; open = text.find('(', open + 1)) {
    double square = 0;
    for (const double v : numbers(text.substr(open + 1, text.find(')', open) - open - 1)))
      square += v * v;
    lengths.push_back(std::sqrt(square));
  }
  return lengths;
}

}  // namespace

void checkNrrdHeader(const fs::path& path, const Progress& progress) {
  const TextHeader header = readNrrdHeader(path);
  int axis = 0;
  for (const double value : numbers(header.get("spacings"))) {
    ++axis;
    if (!std::isnan(value)) checkStatedSpacing(path, "spacings", axis, value);  // NaN: not spatial
  }
  axis = 0;
  for (const double value : vectorLengths(header.get("space directions")))
    checkStatedSpacing(path, "space directions", ++axis, value);
  const double voxels = voxelCount(path, "sizes", header.get("sizes"));
  const double needed = voxels * nrrdBytes(lowerCase(header.get("type")));
  const std::string file = header.get("data file") + header.get("datafile");
  const std::string encoding = lowerCase(header.get("encoding"));
  const bool skips = header.field.contains("byte skip") || header.field.contains("byteskip") ||
                     header.field.contains("line skip") || header.field.contains("lineskip");
  if (encoding.empty()) throw invalidInput(path.string() + ": its NRRD header has no encoding");
  if (encoding == "raw")
    checkData(path, file, header.size, needed, Packing::None, progress);
  else if (encoding == "gzip" || encoding == "gz")
    checkData(path, file, header.size, needed, skips ? Packing::Unchecked : Packing::Deflate,
              progress);
  else if (encoding == "hex" || encoding == "ascii" || encoding == "text" || encoding == "txt")
    checkData(path, file, header.size, voxels, Packing::None, progress);
  else
    throw unsupported(path.string() + ": its encoding is \"" + header.get("encoding") +
                      "\"; expected raw, gzip, hex or text");
}

void checkMetaHeader(const fs::path& path, const Progress& progress) {
  const TextHeader header = readMetaHeader(path);
  for (const char* key : {"ElementSpacing", "ElementSize"}) {
    int axis = 0;
    for (const double value : numbers(header.get(lowerCase(key))))
      checkStatedSpacing(path, key, ++axis, value);
  }
  const std::string file = header.get("elementdatafile");
  const double needed = voxelCount(path, "sizes (DimSize)", header.get("dimsize")) *
                        metaBytes(header.get("elementtype"));
  checkData(path, lowerCase(file) == "local" ? "" : file, header.size, needed,
            lowerCase(header.get("compresseddata")) == "true" ? Packing::Deflate : Packing::None,
            progress);
}

}  // namespace lumen::convert
