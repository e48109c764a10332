// SPDX-License-Identifier: Apache-2.0
#include "converters/io/vtk/vtk_xml.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/length_unit.h"
#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/base/shown_text.h"
#include "converters/io/vtk/xml_events.h"
#include "formats/container/printable.h"

namespace lumen {

const VtkArray* VtkPolyData::pointArray(std::string_view name) const {
  const auto found = std::find_if(pointData.begin(), pointData.end(),
                                  [&](const VtkArray& array) { return array.name == name; });
  return found == pointData.end() ? nullptr : &*found;
}

const VtkArray* VtkPolyData::cellArray(std::string_view name) const {
  const auto found = std::find_if(cellData.begin(), cellData.end(),
                                  [&](const VtkArray& array) { return array.name == name; });
  return found == cellData.end() ? nullptr : &*found;
}

std::vector<std::string> VtkPolyData::unknownWords() const {
  std::vector<std::string> sentences;
  if (!trimmed(unit).empty() && !convert::millimetresPer(unit))
    sentences.push_back("its unit is " + convert::quotedText(unit) +
                        ", which is not known as a length; " + kOption.unit.shown() + " states it");
  if (!trimmed(space).empty() && convert::axesIn(space) == convert::StatedAxes::None)
    sentences.push_back("its axes are " + convert::quotedText(space) +
                        "; lumen knows LPS and RAS, and takes LPS; " + kOption.frame.shown() +
                        " states them");
  return sentences;
}

bool isVtkUnit(std::string_view name) {
  const std::string word = lowerCase(std::string(name));
  return word == "unit" || word == "units" || word == "lengthunit" || word == "lengthunits";
}

bool isVtkSpace(std::string_view name) {
  return lowerCase(std::string(name)) == "space";
}

namespace {

std::string quoted(std::string_view text) {
  return convert::quotedText(std::string(text));
}

constexpr int kDeepest = 16;  // limit; the format itself is five levels deep
constexpr std::uint32_t kMostComponents = 64;
constexpr std::uint32_t kMostIndices = std::numeric_limits<std::uint32_t>::max();

enum Section {
  kPoints,
  kPointData,
  kCellData,
  kVerts,
  kLines,
  kPolys,
  kStrips,
  kFieldData,
  kNoSection
};
constexpr std::array<const char*, 8> kSectionNames = {
    "Points", "PointData", "CellData", "Verts", "Lines", "Polys", "Strips", "FieldData"};

// A <DataArray>, or an <Array> of texts, as described by its tag.
struct Element {
  Section section = kNoSection;
  std::string name, type;
  VtkForm form = VtkForm::Ascii;
  bool isAppended = false;
  std::uint64_t offset = 0;
  std::uint64_t components = 1;
  std::size_t from = 0, to = 0;  // range of its text in the file
  std::size_t line = 0;
};

struct XmlPiece {
  std::uint64_t points = 0;
  std::array<std::uint64_t, 7> cells{};  // count of each section
  std::vector<Element> elements;
};

struct Document {
  VtkPacking packing;
  std::vector<XmlPiece> pieces;
  std::vector<Element> field;
  std::optional<std::size_t> appended;  // first byte behind the underscore
  bool isAppendedBase64 = false;
};

class VtkXmlParser : XmlEvents {
public:
  VtkXmlParser(std::string_view text, const std::string& name,
               std::span<const std::string_view> wanted)
      : XmlEvents(text, name), m_wanted(wanted) {}

  Document parse() {
    run();
    if (!m_isFile) throw invalidInput(m_name + ": has no <VTKFile>; expected a file of VTK (.vtp)");
    if (m_document.pieces.empty())
      throw invalidInput(m_name + ": has no <Piece>; expected one at least");
    return std::move(m_document);
  }

private:
  void begin(std::string_view name, const char** attributes) override {
    if (++m_depth > kDeepest) return refuse("has elements more than 16 deep");
    if (name == "VTKFile") return beginFile(attributes);
    if (!m_isFile) return refuse("begins with " + quoted(name) + "; expected <VTKFile>");
    if (name == "Piece") return beginPiece(attributes);
    if (name == "AppendedData") return beginAppended(attributes);
    if (name == "DataArray") return beginArray(attributes);
    // texts as VTK writes them
    if (name == "Array" && m_section == kFieldData) return beginArray(attributes);
    for (std::size_t s = 0; s < kSectionNames.size(); ++s)
      if (name == kSectionNames[s]) beginSection(static_cast<Section>(s));
  }

  void beginSection(Section section) {
    m_section = section;
    m_isOpen = false;  // an array around a section has no end
  }

  void end(std::string_view name) override {
    --m_depth;
    if ((name == "DataArray" || name == "Array") && m_isOpen) {
      m_isOpen = false;
      Element& element = elements().back();
      // keys may follow the data within the element
      element.to = std::min({tagBegin(), m_text.find('<', element.from), m_text.size()});
      element.to = std::max(element.from, element.to);
    }
    if (m_section != kNoSection && name == kSectionNames[m_section]) {
      m_section = kNoSection;
      m_isOpen = false;
    }
    if (name == "Piece") m_inPiece = false;
  }

  void beginFile(const char** attributes) {
    m_isFile = true;
    const std::string_view type = attribute(attributes, "type");
    if (type != "PolyData")
      return refuse("is of the type " + quoted(type) + "; expected PolyData" + kMakePolyData,
                    ErrorKind::Unsupported);
    m_document.packing.bigEndian = attribute(attributes, "byte_order") == "BigEndian";
    const std::string_view header = attribute(attributes, "header_type");
    if (header == "UInt64")
      m_document.packing.headerBytes = 8;
    else if (!header.empty() && header != "UInt32")
      return refuse("has the header_type " + quoted(header) + "; expected UInt32 or UInt64");
    const std::string_view packer = attribute(attributes, "compressor");
    m_document.packing.zlib = !packer.empty();
    if (!packer.empty() && packer != "vtkZLibDataCompressor")
      refuse("is packed by " + quoted(packer) +
                 "; lumen reads vtkZLibDataCompressor and unpacked data, one of which ParaView's "
                 "Save Data offers",
             ErrorKind::Unsupported);
  }

  void beginPiece(const char** attributes) {
    XmlPiece piece;
    piece.points = count(attributes, "NumberOfPoints");
    piece.cells[kVerts] = count(attributes, "NumberOfVerts");
    piece.cells[kLines] = count(attributes, "NumberOfLines");
    piece.cells[kPolys] = count(attributes, "NumberOfPolys");
    piece.cells[kStrips] = count(attributes, "NumberOfStrips");
    m_document.pieces.push_back(std::move(piece));
    m_inPiece = true;
    m_isOpen = false;  // an array around this piece has no end
  }

  // The list that holds the open array.
  std::vector<Element>& elements() {
    return m_section == kFieldData ? m_document.field : m_document.pieces.back().elements;
  }

  void beginArray(const char** attributes) {
    const bool isField = m_section == kFieldData;
    if (!(m_inPiece || isField) || m_section == kNoSection) return;
    Element element;
    element.section = m_section;
    element.name = attribute(attributes, "Name");
    if (isField && (attribute(attributes, "type") != "String" ||
                    !(isVtkUnit(element.name) || isVtkSpace(element.name))))
      return;
    const bool isData = m_section == kPointData || m_section == kCellData;
    if (isData && std::find(m_wanted.begin(), m_wanted.end(), element.name) == m_wanted.end())
      return;
    element.type = attribute(attributes, "type");
    element.line = line();
    if (!attribute(attributes, "NumberOfComponents").empty())
      element.components = count(attributes, "NumberOfComponents");
    if (element.components == 0 || element.components > kMostComponents)
      return refuse("has an array of " + std::to_string(element.components) +
                    " components; expected 1 to 64");
    const std::string_view form = attribute(attributes, "format");
    element.isAppended = form == "appended";
    if (form == "binary")
      element.form = VtkForm::Base64;
    else if (!element.isAppended && !form.empty() && form != "ascii")
      return refuse("has the format " + quoted(form) + "; expected ascii, binary or appended");
    element.offset = element.isAppended ? count(attributes, "offset") : 0;
    element.from = tagEnd();
    elements().push_back(std::move(element));
    m_isOpen = true;
  }

  // The appended data need not be XML.
  void beginAppended(const char** attributes) {
    m_document.isAppendedBase64 = attribute(attributes, "encoding") == "base64";
    const std::size_t from = tagEnd();
    const std::size_t mark = m_text.find_first_not_of(" \t\r\n", from);
    if (mark == m_text.npos || m_text[mark] != '_')
      return refuse("has appended data that do not begin with an underscore");
    m_document.appended = mark + 1;
    stop();
  }

  std::uint64_t count(const char** attributes, const char* name) {
    const std::string_view text = attribute(attributes, name);
    std::uint64_t value = 0;
    if (text.empty()) return 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() ||
        value > (std::uint64_t{1} << 48))
      refuse(std::string("has the ") + name + " " + quoted(text) + "; expected a whole number");
    return value;
  }

  std::span<const std::string_view> m_wanted;
  Document m_document;
  int m_depth = 0;
  bool m_isFile = false, m_inPiece = false, m_isOpen = false;
  Section m_section = kNoSection;
};

// Merges the pieces of a document.
class Assembler {
public:
  Assembler(const Document& document, std::string_view text, const std::string& name)
      : m_document(document), m_text(text), m_name(name) {
    for (const XmlPiece& piece : document.pieces)
      for (const Element& element : piece.elements)
        if (element.isAppended) m_offsets.push_back(element.offset);
    for (const Element& element : document.field)
      if (element.isAppended) m_offsets.push_back(element.offset);
    std::sort(m_offsets.begin(), m_offsets.end());
  }

  VtkPolyData all() {
    for (const XmlPiece& piece : m_document.pieces) addPoints(piece);
    addCells(kVerts, m_result.verts);
    addCells(kLines, m_result.lines);
    addCells(kPolys, m_result.polys);
    addCells(kStrips, m_result.strips);
    addArrays(kPointData, m_result.pointData);
    addArrays(kCellData, m_result.cellData);
    for (const Element& element : m_document.field)
      (isVtkUnit(element.name) ? m_result.unit : m_result.space) =
          decodeVtkText(encoded(element), m_document.packing, kLongestVtkText);
    return std::move(m_result);
  }

private:
  void addPoints(const XmlPiece& piece) {
    const Element* element = find(piece, kPoints, nullptr);
    if (element == nullptr) {
      if (piece.points != 0)
        refuse("a piece of " + std::to_string(piece.points) + " points has no <Points>");
      return;
    }
    if (element->components != 3)
      refuse(place(*element) + " has " + std::to_string(element->components) +
             " components; expected 3");
    const std::vector<double> values = numbers(*element, piece.points);
    for (std::size_t i = 0; i + 2 < values.size(); i += 3)
      m_result.position.emplace_back(values[i], values[i + 1], values[i + 2]);
    if (m_result.position.size() >= kMostIndices) refuse("has more than 2^32 points");
  }

  void addCells(Section section, VtkCells& cells) {
    std::size_t first = 0;  // index of the piece's first point
    for (const XmlPiece& piece : m_document.pieces) {
      if (piece.cells[section] > 0) addCells(piece, section, first, cells);
      first += static_cast<std::size_t>(piece.points);
    }
  }

  void addCells(const XmlPiece& piece, Section section, std::size_t first, VtkCells& cells) {
    const Element* ends = find(piece, section, "offsets");
    const Element* points = find(piece, section, "connectivity");
    if (ends == nullptr || points == nullptr)
      refuse(std::string("<") + kSectionNames[section] + "> has no " +
             (ends == nullptr ? "offsets" : "connectivity"));
    const std::size_t before = cells.point.size();
    double last = 0;
    for (const double end : numbers(*ends, piece.cells[section])) {
      if (!(end >= last && end == std::floor(end) && end + double(before) < double(kMostIndices)))
        refuse(place(*ends) + " has the value " + foundNumber(end) +
               "; expected whole numbers that do not fall");
      last = end;
      cells.end.push_back(static_cast<std::uint32_t>(before + static_cast<std::size_t>(end)));
    }
    for (const double point : numbers(*points, static_cast<std::uint64_t>(last))) {
      if (!(point >= 0 && point < double(piece.points) && point == std::floor(point)))
        refuse(place(*points) + " has the value " + foundNumber(point) +
               "; expected indices of the " + std::to_string(piece.points) + " points");
      cells.point.push_back(static_cast<std::uint32_t>(first + static_cast<std::size_t>(point)));
    }
  }

  void addArrays(Section section, std::vector<VtkArray>& arrays) {
    for (const Element& model : m_document.pieces.front().elements) {
      if (model.section != section) continue;
      const auto isNamed = [&](const VtkArray& array) { return array.name == model.name; };
      if (std::any_of(arrays.begin(), arrays.end(), isNamed)) continue;
      VtkArray array{model.name, static_cast<std::uint32_t>(model.components), {}};
      if (addValues(section, array)) arrays.push_back(std::move(array));
    }
  }

  // False unless all pieces have it.
  bool addValues(Section section, VtkArray& array) {
    for (const XmlPiece& piece : m_document.pieces) {
      const Element* element = find(piece, section, array.name.c_str());
      if (element == nullptr || element->components != array.components) return false;
      const std::uint64_t count = section == kPointData
                                      ? piece.points
                                      : piece.cells[kVerts] + piece.cells[kLines] +
                                            piece.cells[kPolys] + piece.cells[kStrips];
      const std::vector<double> values = numbers(*element, count);
      array.values.insert(array.values.end(), values.begin(), values.end());
    }
    return true;
  }

  // The last array of a section and name, or of any name if it is null.
  static const Element* find(const XmlPiece& piece, Section section, const char* name) {
    const Element* found = nullptr;
    for (const Element& element : piece.elements)
      if (element.section == section && (name == nullptr || element.name == name)) found = &element;
    return found;
  }

  std::vector<double> numbers(const Element& element, std::uint64_t tuples) {
    return decodeVtkNumbers(encoded(element), m_document.packing, tuples * element.components);
  }

  VtkEncodedArray encoded(const Element& element) {
    VtkEncodedArray array{element.type, element.form, {}, m_name + ": " + place(element)};
    if (element.isAppended) {
      array.form = m_document.isAppendedBase64 ? VtkForm::Base64 : VtkForm::Raw;
      array.text = appendedText(element);
    } else {
      array.text = m_text.substr(element.from, element.to - element.from);
    }
    return array;
  }

  // The appended data of an array, up to the next array: no byte belongs to two arrays.
  std::string_view appendedText(const Element& element) const {
    if (!m_document.appended)
      refuse(place(element) + " is appended, but the file has no appended data");
    const std::string_view all = m_text.substr(*m_document.appended);
    if (element.offset > all.size())
      refuse(place(element) + " has the offset " + std::to_string(element.offset) +
             ", behind the end of the file");
    const auto [same, next] = std::equal_range(m_offsets.begin(), m_offsets.end(), element.offset);
    if (next - same > 1)
      refuse(place(element) + " has the offset " + std::to_string(element.offset) +
             ", as another one; expected data of its own");
    const std::uint64_t end = next == m_offsets.end() ? all.size() : *next;
    return all.substr(static_cast<std::size_t>(element.offset),
                      static_cast<std::size_t>(end - element.offset));
  }

  static std::string place(const Element& element) {
    return "line " + std::to_string(element.line) + ": the array " +
           convert::quotedText(element.name);
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw invalidInput(m_name + ": " + what);
  }

  const Document& m_document;
  std::string_view m_text;
  const std::string& m_name;
  std::vector<std::uint64_t> m_offsets;  // offsets of appended arrays, ascending
  VtkPolyData m_result;
};

}  // namespace

VtkPolyData parseVtkXml(std::string_view text, const std::string& name,
                        std::span<const std::string_view> wanted) {
  const std::string shown = formats::printable(name);
  const Document document = VtkXmlParser(text, shown, wanted).parse();
  return Assembler(document, text, shown).all();
}

}  // namespace lumen
