// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/spatial_graph_data.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include <zlib.h>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/io/vtk/stored_number.h"
#include "converters/io/vtk/text_cursor.h"

namespace lumen::convert {
namespace {

constexpr std::uint64_t kMostValues = std::uint64_t{1} << 28;
constexpr std::size_t kMostFields = 1000, kMostComponents = 16, kDeepest = 1000;
constexpr std::size_t kZipExpansion = 1032, kRleExpansion = 127;  // limits of the codecs

constexpr std::pair<std::string_view, std::size_t> kTypes[] = {
    {"float", 4}, {"double", 8}, {"int", 4}, {"byte", 1}, {"short", 2}, {"ushort", 2}, {"long", 8}};

std::size_t bytesOf(std::string_view type) {
  for (const auto& [name, bytes] : kTypes)
    if (type == name) return bytes;
  return 0;
}

double numberAt(const char* bytes, std::string_view type, Endian endian) {
  if (type == "float") return double{loadNumber<float>(bytes, endian)};
  if (type == "double") return loadNumber<double>(bytes, endian);
  if (type == "int") return loadNumber<std::int32_t>(bytes, endian);
  if (type == "short") return loadNumber<std::int16_t>(bytes, endian);
  if (type == "ushort") return loadNumber<std::uint16_t>(bytes, endian);
  if (type == "long") return static_cast<double>(loadNumber<std::int64_t>(bytes, endian));
  return loadNumber<std::uint8_t>(bytes, endian);
}

// A byte above 127 is followed by a run of that length less 128, any other by the byte that it repeats.
std::optional<std::string> unpackedRuns(std::string_view packed, std::size_t size) {
  std::string bytes;
  for (std::size_t at = 0; at < packed.size() && bytes.size() < size;) {
    const auto head = static_cast<unsigned char>(packed[at++]);
    const std::size_t count = head & 0x7FU;
    if (head > 127) {
      if (count > packed.size() - at) return {};
      bytes.append(packed.substr(at, count));
      at += count;
    } else {
      if (at == packed.size()) return {};
      bytes.append(count, packed[at++]);
    }
  }
  return bytes.size() == size ? std::optional(std::move(bytes)) : std::nullopt;
}

std::optional<std::string> inflated(std::string_view packed, std::size_t size) {
  std::string bytes(size, '\0');
  auto length = static_cast<uLongf>(size);
  const int result =
      uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                 reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
  if (result != Z_OK || length != size) return {};
  return bytes;
}

class AmiraParser {
public:
  AmiraParser(std::string_view bytes, const std::string& name)
      : m_bytes(bytes), m_cursor(bytes, name) {}

  AmiraFile parse() {
    readFirstLine();
    std::string_view word;
    while (!(word = m_cursor.word()).empty() && !word.starts_with('@')) readDeclaration(word);
    requireGraph();
    for (; !word.empty(); word = m_cursor.word()) {
      if (!word.starts_with('@'))
        m_cursor.refuse("is " + quotedText(std::string(word)) +
                        "; expected @ and the number of a field");
      readData(static_cast<int>(m_cursor.parseWhole(word.substr(1), "a number behind @", 100000)));
    }
    for (const AmiraField& field : m_file.fields)
      if (field.values.empty() && countOf(field) > 0)
        m_cursor.refuse("is the last, but the data @" + std::to_string(field.data) + " of " +
                        quotedText(field.name) + " are missing");
    return std::move(m_file);
  }

private:
  void readFirstLine() {
    const std::string line(m_cursor.restOfLine());
    const auto has = [&](const char* word) { return line.find(word) != line.npos; };
    if (!line.starts_with('#') || !(has("Amira") || has("Avizo")))
      m_cursor.refuse("is " + quotedText(line) + "; expected # AmiraMesh or # Avizo");
    if (has("HyperSurface"))
      throw unsupported(
          m_cursor.name() +
          ": is a surface of Amira (HyperSurface); Amira saves surfaces as STL or PLY, "
          "which lumen reads");
    m_isBinary = has("BINARY");
    m_endian = has("LITTLE-ENDIAN") ? Endian::Little : Endian::Big;
  }

  void readDeclaration(std::string_view word) {
    if (word.starts_with('#')) {
      m_cursor.restOfLine();
    } else if (word == "define") {
      const std::string location(m_cursor.wordOfLine());
      m_file.counts[location] = m_cursor.whole("the number behind define", kMostValues);
      m_cursor.restOfLine();  // a volume has three
    } else if (word == "Parameters") {
      readParameters();
    } else {
      readField(std::string(word));
    }
  }

  void readParameters() {
    do {
      if (m_cursor.left() == 0) m_cursor.refuse("ends within the parameters; expected }");
      takeLine(std::string(m_cursor.restOfLine()));
    } while (!m_open.empty());
  }

  // Braces, words, and texts between quotation marks, of one or several lines; commas end values.
  void takeLine(const std::string& line) {
    for (std::size_t at = 0; at < line.size() || m_isQuoted;) {
      if (m_isQuoted) {
        const std::size_t end = endOfQuote(line, at);
        m_quoted.append(line, at, end - at);
        if (end == line.size()) return;
        m_isQuoted = false;
        takeParameter(std::exchange(m_quoted, {}), true);
        at = end + 1;
      } else if (line[at] == '"') {
        m_isQuoted = true;
        ++at;
      } else if (line[at] == ' ' || line[at] == '\t' || line[at] == ',') {
        ++at;
      } else {
        std::size_t end = at + 1;
        if (line[at] != '{' && line[at] != '}')
          end = std::min(line.find_first_of(" \t,{}\"", end), line.size());
        takeParameter(line.substr(at, end - at), false);
        if (m_open.empty()) return;
        at = end;
      }
    }
  }

  // The place of the quotation mark that ends a text, or of the line's end; \" is part of the text.
  static std::size_t endOfQuote(const std::string& line, std::size_t at) {
    while (at < line.size() && line[at] != '"') at += line[at] == '\\' ? 2 : 1;
    return std::min(at, line.size());
  }

  void takeParameter(std::string word, bool isQuoted) {
    if (!isQuoted && word == "{") {
      if (m_open.size() == kDeepest) m_cursor.refuse("opens more than 1000 braces");
      m_open.push_back(m_key);
    } else if (!isQuoted && word == "}") {
      if (m_open.empty()) m_cursor.refuse("closes a brace that is not open");
      m_open.pop_back();
    } else if (m_open.size() == 1 && m_key == "TransformationMatrix" &&
               m_file.transform.size() < 16) {
      m_file.transform.push_back(m_cursor.parseNumber(word, "a number of TransformationMatrix"));
      return;
    } else if (isQuoted && m_open.size() == 1 && m_key == "ContentType") {
      m_file.content = word;
    } else if (isQuoted && m_open.size() == 2 && m_open.back() == "Units" &&
               m_key == "Coordinates") {
      m_file.unit = word;
    }
    m_key = std::move(word);
  }

  void readField(std::string location) {
    AmiraField field;
    field.location = std::move(location);
    std::string line(m_cursor.restOfLine());
    for (char& c : line)
      if (c == '{' || c == '}' || c == '[' || c == ']' || c == '(' || c == ')' || c == ',' ||
          c == '=')
        c = ' ';
    TextCursor words(line, m_cursor.name(), m_cursor.line());
    field.type = std::string(words.word());
    std::string_view word = words.word();
    if (!word.empty() && word[0] >= '0' && word[0] <= '9') {
      field.components = words.parseWhole(word, "the number of components", kMostComponents);
      word = words.word();
    }
    field.name = std::string(word);
    word = words.word();
    if (bytesOf(field.type) == 0 || !word.starts_with('@') || field.components == 0 ||
        m_file.fields.size() == kMostFields)
      m_cursor.refuse("ends the declaration of " + quotedText(field.location) +
                      ", which is none; expected such as POINT { float thickness } @5");
    field.data = static_cast<int>(words.parseWhole(word.substr(1), "a number behind @", 100000));
    field.codec = std::string(words.word());
    if (!field.codec.empty())
      field.codecBytes = words.whole("the size of packed data", kMostValues);
    m_file.fields.push_back(std::move(field));
  }

  void requireGraph() const {
    if (m_file.content == "HxSpatialGraph" ||
        m_file.field("POINT", "EdgePointCoordinates") != nullptr)
      return;
    const bool isVolume = m_file.counts.contains("Lattice");
    throw unsupported(
        m_cursor.name() + ": holds " +
        (isVolume                 ? std::string("a volume of Amira")
         : m_file.content.empty() ? std::string("no ContentType")
                                  : quotedText(m_file.content)) +
        "; expected a spatial graph (HxSpatialGraph)" +
        (isVolume ? "; Amira saves volumes as NRRD or DICOM, which lumen reads" : ""));
  }

  [[nodiscard]] std::uint64_t countOf(const AmiraField& field) const {
    const auto count = m_file.counts.find(field.location);
    return count == m_file.counts.end() ? 0 : count->second * field.components;
  }

  void readData(int number) {
    const auto field = std::find_if(
        m_file.fields.begin(), m_file.fields.end(),
        [&](const AmiraField& one) { return one.data == number && one.values.empty(); });
    if (field == m_file.fields.end())
      m_cursor.refuse("begins the data @" + std::to_string(number) +
                      ", which no field has; expected those of the header");
    const std::uint64_t count = countOf(*field);
    if (!m_isBinary) return readText(*field, count);
    m_cursor.restOfLine();
    const std::uint64_t size = count * bytesOf(field->type);
    const std::uint64_t stored = field->codec.empty() ? size : field->codecBytes;
    const std::uint64_t expansion = field->codec.empty()      ? 1
                                    : field->codec == "HxZip" ? kZipExpansion
                                                              : kRleExpansion;
    if (stored > m_cursor.left() || size > stored * expansion)
      m_cursor.refuse("begins the data @" + std::to_string(number) + " of " + std::to_string(size) +
                      " bytes, more than the file holds");
    const std::string_view raw = m_bytes.substr(m_cursor.offset(), stored);
    m_cursor.skip(stored);
    decode(*field, raw, count);
  }

  void decode(AmiraField& field, std::string_view raw, std::uint64_t count) {
    const std::size_t width = bytesOf(field.type);
    std::optional<std::string> unpacked;
    if (field.codec == "HxZip")
      unpacked = inflated(raw, count * width);
    else if (field.codec == "HxByteRLE")
      unpacked = unpackedRuns(raw, count * width);
    else if (!field.codec.empty())
      m_cursor.refuse("ends data in the codec " + quotedText(field.codec) +
                      "; expected HxZip or HxByteRLE; Amira saves without by \"ASCII\"");
    if (!field.codec.empty() && !unpacked)
      m_cursor.refuse("ends data of " + quotedText(field.name) + " that cannot be unpacked");
    const std::string_view bytes = unpacked ? std::string_view(*unpacked) : raw;
    field.values.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i)
      field.values.push_back(numberAt(bytes.data() + i * width, field.type, m_endian));
  }

  void readText(AmiraField& field, std::uint64_t count) {
    if (count > m_cursor.left() / 2 + 1)  // a number takes at least a digit and a blank
      m_cursor.refuse("begins the data @" + std::to_string(field.data) + " of " +
                      std::to_string(count) + " numbers, more than the file holds");
    const std::string what = "a number of " + quotedText(field.name);
    field.values.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) field.values.push_back(m_cursor.number(what.c_str()));
  }

  std::string_view m_bytes;
  TextCursor m_cursor;
  AmiraFile m_file;
  bool m_isBinary = false;
  std::vector<std::string> m_open;  // words before braces
  std::string m_key, m_quoted;
  bool m_isQuoted = false;
  Endian m_endian = Endian::Little;
};

}  // namespace

const AmiraField* AmiraFile::field(std::string_view location, std::string_view name) const {
  for (const AmiraField& field : fields)
    if (field.location == location && field.name == name) return &field;
  return nullptr;
}

AmiraFile parseAmira(std::string_view bytes, const std::string& name) {
  return AmiraParser(bytes, name).parse();
}

}  // namespace lumen::convert
