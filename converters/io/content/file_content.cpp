// SPDX-License-Identifier: Apache-2.0
#include "converters/io/content/file_content.h"

#include <array>
#include <filesystem>
#include <istream>
#include <memory>
#include <span>
#include <string_view>
#include <system_error>

#include "converters/base/error.h"
#include "converters/base/options/option_name.h"
#include "converters/base/text.h"
#include "formats/container/container.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLookedAt = 1 << 16;
constexpr const char* kCurves = "a centerline (3D Slicer Markups)";
constexpr const char* kDicom = "a slice (DICOM)";

struct Signature {
  std::size_t offset;
  std::string_view bytes;
  ContentKind kind;
  const char* name;
};

std::span<const Signature> signatures() {
  using namespace std::string_view_literals;
  using enum ContentKind;
  static constexpr std::array<Signature, 23> kTable = {{
      {0, "NRRD00", Volume, "a volume (NRRD)"},
      {0, "ObjectType", Volume, "a volume (MetaImage)"},
      {0, "NDims:", Centerline, "a centerline (TubeTK)"},
      {0, "NDims", Volume, "a volume (MetaImage)"},
      {344, "n+1\0"sv, Volume, "a volume (NIfTI)"},
      {344, "ni1\0"sv, Other, "the header of a pair of files (NIfTI)"},
      {4, "n+2\0"sv, Volume, "a volume (NIfTI)"},
      {128, "DICM", Volume, kDicom},
      {0, "# Markups fiducial file", Seeds, "seeds (3D Slicer fiducials)"},
      {0, "glTF", Mesh, "a mesh (glTF)"},
      {0, "ply\n", Mesh, "a mesh (PLY)"},
      {0, "ply\r\n", Mesh, "a mesh (PLY)"},
      {0, "solid ", Mesh, "a mesh (STL)"},
      {0, "# vtk DataFile", Mesh, "a mesh (VTK)"},
      {0, "<VTKFile", Mesh, "a mesh (VTK)"},
      {0, "\x89PNG", Other, "a picture (PNG)"},
      {0, "\xff\xd8\xff", Other, "a picture (JPEG)"},
      {0, "II*\0"sv, Other, "a picture (TIFF)"},
      {0, "MM\0*"sv, Other, "a picture (TIFF)"},
      {0, "%PDF", Other, "a PDF"},
      {0, "PK\x03\x04", Other, "an archive (zip)"},
      {0, "<!DOCTYPE", Other, "a web page"},
      {0, "version https://git-lfs", Other, "a pointer of Git LFS, whose file was not fetched"},
  }};
  return kTable;
}

/// Kind of a JSON file, by words in its beginning.
FileContent jsonContent(std::string_view text) {
  using enum ContentKind;
  const auto has = [text](std::string_view word) { return text.find(word) != text.npos; };
  if (has("\"lumen-seeds\"")) return {Seeds, "seeds"};
  if (has("\"markups\"") && has("\"Curve\"") && has("\"Radius\"")) return {Centerline, kCurves};
  if (has("\"markups\"")) return {Seeds, "seeds (3D Slicer Markups)"};
  if (has("\"format\"") && has("\"lumen\"")) return {Case, "a case"};
  if (has("\"asset\"")) return {Mesh, "a mesh (glTF)"};
  return {};
}

/// Empty for a file that cannot be read.
std::string readBeginning(const InputFile& file) {
  std::error_code ignored;
  if (file.isFolder() || (!file.isInMemory() && !fs::is_regular_file(file.path(), ignored)))
    return {};
  try {
    std::string text(kLookedAt, '\0');
    const std::unique_ptr<std::istream> stream = file.open();
    stream->read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream->gcount()));
    return text;
  } catch (const Error&) {
    return {};
  }
}

/// Advice for a file of this kind.
std::string adviceFor(ContentKind kind) {
  using enum ContentKind;
  switch (kind) {
    case Volume:
      return "; lumen convert and lumen track make a case of a volume";
    case Seeds:
      return "; " + kOption.seeds.shown() +
             " takes seeds, beside the volume that they were clicked in";
    case Case:
      return "; lumen fit, convert, info, compare and validate take a case";
    case Centerline:
      return "; lumen convert makes a case of a centerline";
    case Mesh:
      return "; lumen info describes a mesh, lumen convert makes a case of the surface of vessels";
    case Unknown:
    case Other:
      break;
  }
  return "";
}

/// Content that a signature alone states.
FileContent plainContent(const Signature& signature) {
  const std::string_view name = signature.name;
  if (name.starts_with("a picture"))
    return {signature.kind, signature.name,
            "3D Slicer and Fiji save a stack of pictures as one volume, .nrrd"};
  if (name.starts_with("the header"))
    return {signature.kind, signature.name,
            "3D Slicer and nibabel's nib-convert write one file with header and voxels, .nii"};
  return {signature.kind, signature.name, ""};
}

/// Content of a zip, by the name's ending.
FileContent zipContent(const std::string& name) {
  using enum ContentKind;
  if (name.ends_with(".3mf"))
    return {Other, "a mesh (3MF)",
            "lumen does not read 3MF; the program that wrote it, MeshLab or PrusaSlicer saves it "
            "as STL or OBJ"};
  if (name.ends_with(".mrb"))
    return {Other, "a bundle of 3D Slicer (.mrb), a zip",
            "unzip it: its folder Data has volumes (.nrrd), models (.vtp, .vtk) and curves "
            "(.mrk.json), which lumen reads"};
  return {Other, "an archive (zip)", "unzip it, and name a file or folder in it"};
}

/// Content of a text of other programs' networks and scenes, by its first words.
FileContent textContent(std::string_view text) {
  using enum ContentKind;
  const auto has = [text](std::string_view word) { return text.find(word) != text.npos; };
  if (text.starts_with("# AmiraMesh") || text.starts_with("# Avizo") ||
      text.starts_with("# Amira "))
    return has("HxSpatialGraph") ? FileContent{Centerline, "a centerline (Amira)", ""}
                                 : FileContent{Other, "a file of Amira that is no spatial graph",
                                               "Amira saves volumes as NRRD and surfaces as STL"};
  if (has("$VERT_LIST_BEGIN")) return {Centerline, "a centerline (VessMorphoVis)", ""};
  if (has("<graphml")) return {Centerline, "a centerline (GraphML)", ""};
  if (has("<contourgroup ") || (has("<path ") && has("<path_element")))
    return {Centerline, "a centerline (SimVascular)", ""};
  if (has("<MRML"))
    return {Other, "a scene of 3D Slicer (MRML)",
            "lumen reads the files that it names: volumes (.nrrd), models (.vtp, .vtk) and curves "
            "(.mrk.json)"};
  return {};
}

/// Kind of a VTK XML file, by the counts in its first tags.
FileContent vtkContent(std::string_view text) {
  using enum ContentKind;
  const auto isZero = [text](std::string_view count) {
    const auto at = text.find(count);
    return at == text.npos || text.substr(at + count.size()).starts_with("=\"0\"");
  };
  if (text.find("\"PolyData\"") == text.npos) return {Other, "a VTK file"};
  if (isZero("NumberOfPolys") && isZero("NumberOfStrips") && !isZero("NumberOfLines"))
    return {Centerline, "a centerline (VTK)"};
  return {Other, "a VTK file"};
}

/// Kind of a MetaIO file, by its first object.
FileContent metaContent(std::string_view text) {
  using enum ContentKind;
  const std::string_view head = text.substr(0, text.find("Points ="));
  const bool isImage = head.find("Image") != head.npos || head.find("ElementDataFile") != head.npos;
  if (!isImage && (head.find("Tube") != head.npos || head.find("Scene") != head.npos))
    return {Centerline, "a centerline (TubeTK)"};
  return {Volume, "a volume (MetaImage)"};
}

/// Kind of a DICOM file, by its storage class.
FileContent dicomContent(std::string_view text) {
  using enum ContentKind;
  constexpr std::string_view kSurfaces = "1.2.840.10008.5.1.4.1.1.66.5";
  const std::size_t at = text.substr(0, 1024).find(kSurfaces);
  const std::string_view rest = text.substr(at == text.npos ? text.size() : at + kSurfaces.size());
  const bool isWhole = !rest.empty() && (rest[0] < '0' || rest[0] > '9') && rest[0] != '.';
  return isWhole ? FileContent{Mesh, "a mesh (DICOM)"} : FileContent{Volume, kDicom};
}

std::string nounFor(ContentKind kind) {
  using enum ContentKind;
  switch (kind) {
    case Volume:
      return "a volume";
    case Seeds:
      return "seeds";
    case Mesh:
      return "a mesh";
    case Centerline:
      return "a centerline";
    default:
      return "a case";
  }
}

}  // namespace

std::string FileContent::sentence() const {
  return (kind == ContentKind::Seeds ? "these are " : "this is ") + name;
}

FileContent detectContent(const InputFile& file) {
  using enum ContentKind;
  const std::string text = readBeginning(file);
  const std::string_view view = text;
  if (formats::hasContainerMagic(std::as_bytes(std::span(text)))) return {Case, "a case"};
  for (const Signature& signature : signatures())
    if (view.size() > signature.offset &&
        view.substr(signature.offset).starts_with(signature.bytes))
      return signature.bytes == "<VTKFile"     ? vtkContent(view)
             : signature.bytes == "ObjectType" ? metaContent(view)
             : signature.bytes.starts_with("PK")
                 ? zipContent(lowerCase(file.path().filename().string()))
             : signature.name == kDicom ? dicomContent(view)
                                        : plainContent(signature);
  if (lowerCase(file.path().filename().string()).ends_with(".swc"))
    return {Centerline, "a centerline (SWC)"};
  if (view.starts_with("<?xml") && view.find("<VTKFile") != view.npos) return vtkContent(view);
  if (FileContent content = textContent(view); content.kind != Unknown) return content;
  const auto first = view.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  if (first != view.npos && view[first] == '{') return jsonContent(view);
  const bool packed = view.starts_with("\x1f\x8b");
  if (packed && lowerCase(file.path().filename().string()).ends_with(".nii.gz"))
    return {Volume, "a volume (NIfTI)"};
  return packed ? FileContent{Other, "a file packed by gzip"} : FileContent{};
}

std::string notA(ContentKind wanted, const InputFile& file) {
  const FileContent content = detectContent(file);
  if (content.kind == ContentKind::Unknown || content.kind == wanted) return "";
  // a curve may be seeds or a centerline
  if (wanted == ContentKind::Seeds && content.name == kCurves) return "";
  return content.sentence() + ", not " + nounFor(wanted) +
         (content.advice.empty() ? adviceFor(content.kind) : "; " + content.advice);
}

namespace {

/// Whether a keyword at the beginning of a line announces cells, and not none of them.
bool announces(std::string_view text, std::string_view keyword) {
  for (std::size_t at = text.find(keyword); at != text.npos; at = text.find(keyword, at + 1)) {
    const std::string_view count = text.substr(at + keyword.size());
    const std::size_t digit = count.find_first_not_of(' ');
    const bool isOfLine = at > 0 && (text[at - 1] == '\n' || text[at - 1] == '\r');
    if (isOfLine && digit != count.npos && count[digit] >= '1' && count[digit] <= '9') return true;
  }
  return false;
}

}  // namespace

bool isDicom(const FileContent& content) {
  return content.name == kDicom;
}

bool holdsLegacyLines(const InputFile& file) {
  if (!readBeginning(file).starts_with("# vtk DataFile")) return false;
  constexpr std::size_t kPart = std::size_t{4} << 20, kOverlap = 64;
  bool hasLines = false, hasSurface = false;
  try {
    const std::unique_ptr<std::istream> stream = file.open();
    std::string text;
    do {
      const std::size_t kept = text.size() < kOverlap ? text.size() : kOverlap;
      text.erase(0, text.size() - kept);
      text.resize(kept + kPart);
      stream->read(text.data() + kept, static_cast<std::streamsize>(kPart));
      text.resize(kept + static_cast<std::size_t>(stream->gcount()));
      hasLines = hasLines || announces(text, "LINES ");
      hasSurface =
          hasSurface || announces(text, "POLYGONS ") || announces(text, "TRIANGLE_STRIPS ");
    } while (*stream && !hasSurface);
  } catch (const Error&) {
    return false;
  }
  return hasLines && !hasSurface;
}

}  // namespace lumen::convert
