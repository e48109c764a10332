// SPDX-License-Identifier: Apache-2.0

#include "converters/io/vtk/vtk_legacy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/vtk/stored_number.h"
#include "converters/io/vtk/text_cursor.h"

namespace lumen::convert {
namespace {

std::string quotedWord(std::string_view text) {
  return quotedText(std::string(text));
}

constexpr std::uint64_t kMostComponents = 64;
constexpr std::uint64_t kMostNumbers = std::numeric_limits<std::uint32_t>::max();

struct TypeName {
  std::string_view name;
  char kind;  // i signed, u unsigned, f floating, b bits
  std::size_t size;
};
constexpr std::array<TypeName, 16> kTypeNames = {{
    {"bit", 'b', 1},
    {"unsigned_char", 'u', 1},
    {"char", 'i', 1},
    {"unsigned_short", 'u', 2},
    {"short", 'i', 2},
    {"unsigned_int", 'u', 4},
    {"int", 'i', 4},
    {"unsigned_long", 'u', 8},
    {"long", 'i', 8},
    {"float", 'f', 4},
    {"double", 'f', 8},
    {"vtktypeint64", 'i', 8},
    {"vtktypeuint64", 'u', 8},
    {"vtkidtype", 'i', 4},
    {"unsigned_long_long", 'u', 8},
    {"vtktypeint32", 'i', 4},
}};

double loadBig(const char* at, const TypeName& type) {
  if (type.kind == 'f')
    return type.size == 4 ? static_cast<double>(loadNumber<float>(at, Endian::Big))
                          : loadNumber<double>(at, Endian::Big);
  const bool isSigned = type.kind == 'i';
  switch (type.size) {
    case 1:
      return isSigned ? loadNumber<std::int8_t>(at, Endian::Big)
                      : loadNumber<std::uint8_t>(at, Endian::Big);
    case 2:
      return isSigned ? loadNumber<std::int16_t>(at, Endian::Big)
                      : loadNumber<std::uint16_t>(at, Endian::Big);
    case 4:
      return isSigned ? loadNumber<std::int32_t>(at, Endian::Big)
                      : loadNumber<std::uint32_t>(at, Endian::Big);
    default:
      return isSigned ? static_cast<double>(loadNumber<std::int64_t>(at, Endian::Big))
                      : static_cast<double>(loadNumber<std::uint64_t>(at, Endian::Big));
  }
}

class LegacyParser {
public:
  LegacyParser(std::string_view bytes, const std::string& name,
               std::span<const std::string_view> wanted)
      : m_bytes(bytes), m_text(bytes, name), m_wanted(wanted) {}

  VtkPolyData parse() {
    parseHead();
    for (std::string word = keyword(); !word.empty(); word = keyword()) {
      if (word == "points")
        parsePoints();
      else if (VtkCells* cells = cellsOf(word))
        parseCells(*cells);
      else if (word == "cell_data" || word == "point_data")
        beginData(word == "cell_data");
      else if (word == "metadata")
        passMetadata();
      else
        parseArray(word);
    }
    checkIndices();
    return std::move(m_data);
  }

private:
  std::string keyword() { return lowerCase(std::string(m_text.word())); }

  void parseHead() {
    const std::string_view first = m_text.restOfLine();
    constexpr std::string_view kFirst = "# vtk DataFile Version ";
    if (!first.starts_with(kFirst))
      m_text.refuse("begins with " + quotedWord(first) + "; expected \"# vtk DataFile Version\"");
    m_isOffsets = first.substr(kFirst.size()).starts_with('5');
    m_data.title = m_text.restOfLine();
    const std::string form = lowerCase(std::string(m_text.word()));
    if (form != "ascii" && form != "binary")
      m_text.refuse("found " + quotedWord(form) + "; expected ASCII or BINARY");
    m_isBinary = form == "binary";
    if (keyword() != "dataset") m_text.refuse("expected DATASET");
    const std::string_view kind = m_text.word();
    if (lowerCase(std::string(kind)) != "polydata")
      throw unsupported(m_text.name() + ": " + m_text.place() + ": the data set is " +
                        quotedWord(kind) + "; lumen reads POLYDATA" + kMakePolyData);
  }

  VtkCells* cellsOf(const std::string& word) {
    if (word == "vertices") return &m_data.verts;
    if (word == "lines") return &m_data.lines;
    if (word == "polygons") return &m_data.polys;
    return word == "triangle_strips" ? &m_data.strips : nullptr;
  }

  const TypeName& typeOf(std::string_view word) const {
    const std::string lower = lowerCase(std::string(word));
    for (const TypeName& type : kTypeNames)
      if (type.name == lower) return type;
    m_text.refuse("the type is " + quotedWord(word) + "; expected one such as float or int");
  }

  /// Hands `take` each of the `count` numbers that follow, as text, or big-endian after the end of
  /// this line.
  template <class Take>
  void numbers(std::uint64_t count, const TypeName& type, const char* what, Take take) {
    const bool isBits = type.kind == 'b';
    const std::uint64_t least = m_isBinary ? type.size : 2;
    if (m_isBinary) m_text.restOfLine();
    const std::uint64_t bytes = isBits && m_isBinary ? (count + 7) / 8 : count;
    // the last number of a text has no blank after it
    if (bytes > m_text.left() / least + (m_isBinary ? 0 : 1))
      m_text.refuse(std::to_string(count) + " numbers of " + what +
                    " are announced; expected at most " + std::to_string(m_text.left() / least) +
                    ", for which there are bytes");
    if (!m_isBinary) {
      for (std::uint64_t i = 0; i < count; ++i) take(m_text.number(what));
      return;
    }
    const std::size_t from = m_text.offset();
    for (std::uint64_t i = 0; i < count && !isBits; ++i)
      take(loadBig(m_bytes.data() + from + static_cast<std::size_t>(i) * type.size, type));
    m_text.skip(static_cast<std::size_t>(bytes) * type.size);
  }

  void parsePoints() {
    const std::uint64_t count = m_text.whole("the number of points", kMostNumbers);
    const TypeName& type = typeOf(m_text.word());
    std::array<double, 3> p{};
    std::size_t a = 0;
    m_data.position.clear();
    numbers(3 * count, type, "points", [&](double value) {
      p[a] = value;
      if (++a < 3) return;
      a = 0;
      m_data.position.emplace_back(p[0], p[1], p[2]);
    });
  }

  std::uint32_t indexOf(double value) const {
    if (!(value >= 0 && value < static_cast<double>(kMostNumbers) && value == std::floor(value)))
      m_text.refuse("an index of a cell is " + foundNumber(value) +
                    "; expected a whole number from 0 on");
    return static_cast<std::uint32_t>(value);
  }

  void parseCells(VtkCells& cells) {
    cells = {};
    if (m_isOffsets) return parseOffsets(cells);
    const std::uint64_t count = m_text.whole("the number of cells", kMostNumbers);
    const std::uint64_t size = m_text.whole("the size of the cells", kMostNumbers);
    if (count > size)
      m_text.refuse(std::to_string(count) + " cells are announced in " + std::to_string(size) +
                    " numbers; expected a number for each");
    std::uint32_t left = 0;
    numbers(size, {"int", 'i', 4}, "cells", [&](double value) {
      const std::uint32_t index = indexOf(value);
      if (left > 0) {
        cells.point.push_back(index);
        if (--left == 0) cells.end.push_back(static_cast<std::uint32_t>(cells.point.size()));
      } else if (index > 0) {
        left = index;
      } else {
        cells.end.push_back(static_cast<std::uint32_t>(cells.point.size()));
      }
    });
    if (left > 0 || cells.size() != count)
      m_text.refuse("the cells hold " + std::to_string(cells.size()) + " in " +
                    std::to_string(size) + " numbers; expected " + std::to_string(count));
  }

  /// Cells since version 5: their starts, and the end of the last, then their points.
  void parseOffsets(VtkCells& cells) {
    const std::uint64_t offsets = m_text.whole("the number of offsets", kMostNumbers);
    const std::uint64_t points = m_text.whole("the number of cells' points", kMostNumbers);
    if (offsets == 0) return;
    expect("offsets");
    const TypeName& offsetType = typeOf(m_text.word());
    std::uint32_t last = 0;
    bool isFirst = true;
    numbers(offsets, offsetType, "offsets", [&](double value) {
      const std::uint32_t offset = indexOf(value);
      if (offset < last || offset > points || (isFirst && offset != 0))
        m_text.refuse("an offset of cells is " + std::to_string(offset) + " behind " +
                      std::to_string(last) + "; expected 0 first, then rising ones up to " +
                      std::to_string(points));
      if (!isFirst) cells.end.push_back(offset);
      isFirst = false;
      last = offset;
    });
    expect("connectivity");
    const TypeName& type = typeOf(m_text.word());
    numbers(points, type, "cells' points",
            [&](double value) { cells.point.push_back(indexOf(value)); });
  }

  void expect(const char* expected) {
    const std::string word = keyword();
    if (word != expected) m_text.refuse("found " + quotedWord(word) + "; expected " + expected);
  }

  void beginData(bool ofCells) {
    m_ofCells = ofCells;
    m_hasData = true;
    m_tuples = m_text.whole("the number of values", kMostNumbers);
  }

  /// Name and value pairs up to an empty line.
  void passMetadata() {
    m_text.restOfLine();
    while (m_text.left() > 0 && !m_text.restOfLine().empty()) continue;
  }

  /// An array of points or cells; only `m_wanted` is kept.
  void parseArray(const std::string& word) {
    if (word == "field") return parseField();
    if (!m_hasData)
      m_text.refuse("found " + quotedWord(word) + "; expected POINTS, POLYGONS or another section");
    if (word == "scalars") return parseScalars();
    if (word == "lookup_table") return parseTable();
    std::uint64_t components = 0;
    if (word == "normals" || word == "vectors") components = 3;
    if (word == "tensors") components = 9;
    const std::string name(m_text.word());
    if (word == "texture_coordinates") components = m_text.whole("the number of components", 9);
    if (word == "color_scalars") {
      components = m_text.whole("the number of components", 9);
      return take(name, components, {"unsigned_char", m_isBinary ? 'u' : 'f', 1}, m_tuples);
    }
    if (word == "global_ids" || word == "pedigree_ids") components = 1;
    if (components == 0)
      m_text.refuse("found " + quotedWord(word) +
                    "; expected SCALARS, NORMALS, FIELD or another "
                    "array of VTK");
    take(name, components, typeOf(m_text.word()), m_tuples);
  }

  void parseScalars() {
    const std::string name(m_text.word());
    const TypeName& type = typeOf(m_text.word());
    const std::string_view components = m_text.wordOfLine();
    const std::uint64_t n =
        components.empty() ? 1 : m_text.parseWhole(components, "the number of components", 64);
    expect("lookup_table");
    m_text.word();
    take(name, n, type, m_tuples);
  }

  void parseTable() {
    m_text.word();
    const std::uint64_t size = m_text.whole("the size of a table", kMostNumbers);
    take({}, 4, {"unsigned_char", m_isBinary ? 'u' : 'f', 1}, size);
  }

  void parseField() {
    m_text.word();
    const std::uint64_t arrays = m_text.whole("the number of arrays", kMostNumbers);
    for (std::uint64_t i = 0; i < arrays; ++i) {
      std::string name(m_text.word());
      while (lowerCase(name) == "metadata") {
        passMetadata();
        name = m_text.word();
      }
      if (name.empty()) m_text.refuse("the file ends; expected an array");
      const std::uint64_t components = m_text.whole("the number of components", kMostNumbers);
      const std::uint64_t tuples = m_text.whole("the number of values", kMostNumbers);
      const std::string_view type = m_text.word();
      if (lowerCase(std::string(type)) == "string")
        passTexts(components * tuples, name);
      else
        take(name, components, typeOf(type), tuples);
    }
  }

  /// Texts stand on one line each, or after their lengths; a binary length takes one to eight
  /// bytes. The first of a data set's unit or axes is kept.
  void passTexts(std::uint64_t count, const std::string& name) {
    m_text.restOfLine();
    for (std::uint64_t i = 0; i < count; ++i) {
      if (m_text.left() == 0) m_text.refuse("the file ends; expected a text");
      const std::string_view text = m_isBinary ? binaryText() : m_text.restOfLine();
      if (m_hasData || i > 0) continue;
      if (isVtkUnit(name)) m_data.unit = text.substr(0, kLongestVtkText);
      if (isVtkSpace(name)) m_data.space = text.substr(0, kLongestVtkText);
    }
  }

  std::string_view binaryText() {
    const auto first = static_cast<unsigned char>(m_bytes[m_text.offset()]);
    const std::size_t size = std::size_t{1} << (3 - (first >> 6));
    std::uint64_t length = first & 0x3fU;
    if (size > m_text.left()) m_text.refuse("the file ends; expected a text");
    for (std::size_t b = 1; b < size; ++b)
      length = length << 8 | static_cast<unsigned char>(m_bytes[m_text.offset() + b]);
    if (length > m_text.left() - size) m_text.refuse("the file ends; expected a text");
    m_text.skip(size);
    const std::string_view text = m_bytes.substr(m_text.offset(), static_cast<std::size_t>(length));
    m_text.skip(text.size());
    return text;
  }

  void take(const std::string& name, std::uint64_t components, const TypeName& type,
            std::uint64_t tuples) {
    const bool isWanted = m_hasData && components > 0 && components <= kMostComponents &&
                          std::find(m_wanted.begin(), m_wanted.end(), name) != m_wanted.end();
    VtkArray array{name, isWanted ? static_cast<std::uint32_t>(components) : 1, {}};
    const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    if (components > 0 && tuples > most / components)
      m_text.refuse("an array has " + std::to_string(components) + " components of " +
                    std::to_string(tuples) + " values");
    numbers(components * tuples, type, "an array", [&](double value) {
      if (isWanted) array.values.push_back(value);
    });
    if (isWanted) (m_ofCells ? m_data.cellData : m_data.pointData).push_back(std::move(array));
  }

  void checkIndices() const {
    for (const VtkCells* cells : {&m_data.polys, &m_data.strips})
      for (std::size_t i = 0; i < cells->point.size(); ++i)
        if (cells->point[i] >= m_data.position.size())
          throw invalidInput(m_text.name() + ": corner " + std::to_string(i) + " of the polygons" +
                             ": is point " + std::to_string(cells->point[i]) +
                             "; expected less than " + std::to_string(m_data.position.size()) +
                             ", the number of points");
  }

  std::string_view m_bytes;
  TextCursor m_text;
  std::span<const std::string_view> m_wanted;
  VtkPolyData m_data;
  bool m_isBinary = false, m_isOffsets = false, m_ofCells = false, m_hasData = false;
  std::uint64_t m_tuples = 0;
};

}  // namespace

VtkPolyData parseVtkLegacy(std::string_view bytes, const std::string& name,
                           std::span<const std::string_view> wanted) {
  return LegacyParser(bytes, name, wanted).parse();
}

}  // namespace lumen::convert
