// SPDX-License-Identifier: Apache-2.0
// Surface segmentations of DICOM (PS3.3, C.8.23, C.27). Declared in read_mesh.h.
#include <bit>
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "converters/base/error.h"
#include "converters/io/mesh/mesh_builder.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/io/volume/dicom/dicom_file.h"
#include "converters/io/volume/dicom/dicom_tree.h"

namespace lumen::convert {
namespace {

constexpr DicomTag kSegments = 0x00620002, kLabel = 0x00620005, kReferred = 0x0066002b,
                   kReferredNumber = 0x0066002c, kSurfaces = 0x00660002, kNumber = 0x00660003,
                   kPoints = 0x00660011, kCoordinates = 0x00660016, kPrimitives = 0x00660013,
                   kTriangleList = 0x00660023, kLongTriangles = 0x00660041, kStrips = 0x00660026,
                   kFans = 0x00660027, kFacets = 0x00660034, kIndices = 0x00660029,
                   kLongIndices = 0x00660040;

class SurfaceReader {
public:
  SurfaceReader(const DicomTree& tree, MeshBuilder& builder) : m_tree(tree), m_builder(builder) {}

  MeshFile read() {
    const std::map<std::string, std::string> names = namesOfSurfaces();
    for (const DicomItem& surface : m_tree.top.items(kSurfaces)) {
      const std::string number =
          DicomReader(surface.values, m_tree.isBigEndian).shown(kNumber, DicomType::Whole);
      m_place = "surface " + number;
      const auto name = names.find(number);
      m_builder.beginGroup(name == names.end() ? m_place : name->second);
      addPoints(surface);
      for (const DicomItem& primitives : surface.items(kPrimitives)) addPrimitives(primitives);
    }
    m_builder.file.unitMm = 1;  // DICOM has no other unit
    m_builder.file.frameStated = true;
    return m_builder.finish();
  }

private:
  std::map<std::string, std::string> namesOfSurfaces() const {
    std::map<std::string, std::string> names;
    for (const DicomItem& segment : m_tree.top.items(kSegments))
      for (const DicomItem& referred : segment.items(kReferred))
        names[DicomReader(referred.values, m_tree.isBigEndian)
                  .shown(kReferredNumber, DicomType::Whole)] = segment.text(kLabel);
    return names;
  }

  void addPoints(const DicomItem& surface) {
    m_first = m_builder.points();
    const std::vector<DicomItem>& points = surface.items(kPoints);
    const std::vector<std::uint32_t> words =
        points.empty() ? std::vector<std::uint32_t>() : wordsOf(points[0], kCoordinates, 4);
    if (words.empty() || words.size() % 3 != 0)
      refuseMesh(m_builder.name(), m_place,
                 "its point coordinates " + tagText(kCoordinates) + " have " +
                     std::to_string(words.size()) + " numbers; expected three for each point");
    for (std::size_t n = 0; n < words.size(); n += 3)
      m_builder.addPoint(
          {double{std::bit_cast<float>(words[n])}, double{std::bit_cast<float>(words[n + 1])},
           double{std::bit_cast<float>(words[n + 2])}},
          [&] { return m_place + ", point " + std::to_string(n / 3 + 1); });
  }

  void addPrimitives(const DicomItem& primitives) {
    const std::vector<std::uint32_t> triangles =
        indicesOf(primitives, kTriangleList, kLongTriangles);
    if (triangles.size() % 3 != 0)
      refuseMesh(m_builder.name(), m_place,
                 "its triangles " + tagText(kTriangleList) + " have " +
                     std::to_string(triangles.size()) + " corners; expected three each");
    for (std::size_t n = 0; n < triangles.size(); n += 3)
      m_builder.addTriangle({triangles[n], triangles[n + 1], triangles[n + 2]});
    for (const DicomItem& strip : primitives.items(kStrips)) {
      const std::vector<std::uint32_t> at = indicesOf(strip, kIndices, kLongIndices);
      for (std::size_t n = 2; n < at.size(); ++n)
        m_builder.addTriangle(n % 2 == 0 ? Triangle{at[n - 2], at[n - 1], at[n]}
                                         : Triangle{at[n - 1], at[n - 2], at[n]});
    }
    for (const DicomTag sequence : {kFans, kFacets})
      for (const DicomItem& polygon : primitives.items(sequence)) {
        const std::vector<std::uint32_t> at = indicesOf(polygon, kIndices, kLongIndices);
        if (at.size() >= 3) m_builder.addPolygon(at.data(), at.size());
      }
  }

  /// Indices of points of the mesh, by a list of words of two or of four bytes, which count from 1.
  std::vector<std::uint32_t> indicesOf(const DicomItem& item, DicomTag narrow, DicomTag wide) {
    std::vector<std::uint32_t> indices = wordsOf(item, wide, 4);
    if (indices.empty()) indices = wordsOf(item, narrow, 2);
    const std::size_t count = m_builder.points() - m_first;
    for (std::uint32_t& index : indices) {
      if (index < 1 || index > count)
        refuseMesh(m_builder.name(), m_place,
                   "its index " + std::to_string(index) + " " + tagText(narrow) +
                       " is of no point; expected 1 to " + std::to_string(count));
      index = static_cast<std::uint32_t>(m_first + index - 1);
    }
    return indices;
  }

  [[nodiscard]] std::vector<std::uint32_t> wordsOf(const DicomItem& item, DicomTag tag,
                                                   std::size_t size) const {
    const auto found = item.values.find(tag);
    if (found == item.values.end()) return {};
    const std::string& bytes = found->second;
    std::vector<std::uint32_t> words(bytes.size() / size);
    for (std::size_t n = 0; n < words.size(); ++n)
      for (std::size_t i = 0; i < size; ++i)
        words[n] = words[n] << 8U | static_cast<unsigned char>(
                                        bytes[n * size + (m_tree.isBigEndian ? i : size - 1 - i)]);
    return words;
  }

  const DicomTree& m_tree;
  MeshBuilder& m_builder;
  std::string m_place;
  std::size_t m_first = 0;  // points of other surfaces
};

}  // namespace

MeshFile readDicomSurface(const InputFile& file, const std::string& name) {
  const DicomTree tree = readDicomTree(file, {kSegments, kSurfaces});
  if (tree.top.items(kSurfaces).empty())
    throw invalidInput(name +
                       ": has no surfaces (0066,0002); expected a surface segmentation of "
                       "DICOM");
  MeshBuilder builder(name);
  return SurfaceReader(tree, builder).read();
}

}  // namespace lumen::convert
