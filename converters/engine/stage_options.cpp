// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/stage_options.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <regex>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/options/option_name.h"
#include "converters/base/text.h"
#include "converters/engine/scope.h"
#include "converters/stages/editing/posed_case.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

const std::map<std::string, convert::SeedSystem> kSeedSystems = {
    {"lps", convert::SeedSystem::Lps},
    {"ras", convert::SeedSystem::Ras},
    {"voxel", convert::SeedSystem::Voxel}};

const std::vector<std::string> kPatientFrames = {"lps", "ras"};

template <class Value>
std::vector<std::string> wordsOf(const std::map<std::string, Value>& named) {
  std::vector<std::string> words;
  for (const auto& entry : named) words.push_back(entry.first);
  return words;
}

/// The numbers of a text with commas between them; nothing where one of them is out of range.
std::vector<double> numbersIn(const std::string& text, const NumberRange& range) {
  std::vector<double> values;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const char* const first = text.data() + at + (text.compare(at, 1, "+") == 0 ? 1 : 0);
    double value = 0;
    const auto [stop, error] = std::from_chars(first, text.data() + end, value);
    if (error != std::errc() || stop != text.data() + end || !range.holds(value)) return {};
    values.push_back(value);
    at = end + 1;
  }
  return values;
}

/// The numbers of "0.5" or "0.5,0.5,1"; nothing where one of them is no length.
std::vector<double> spacingIn(const std::string& text) {
  const std::vector<double> values = numbersIn(text, kPositive);
  return values.size() == 1 || values.size() == 3 ? values : std::vector<double>();
}

constexpr NumberRange kPlace{-kLongest, kLongest};
constexpr NumberRange kInputPlace{-1e12, 1e12};  // of an input far from 0, which is moved near it

std::string coordinatesFault(const std::string& text, const NumberRange& range) {
  if (numbersIn(text, range).size() == 3) return {};
  return "found " + (text.empty() ? "nothing" : text) +
         ", expected three coordinates with commas between them, each " + range.text();
}

std::string inputPlaceFault(const std::string& text) {
  return coordinatesFault(text, kInputPlace);
}

std::string spacingFault(const std::string& text) {
  if (!spacingIn(text).empty()) return {};
  return "found " + (text.empty() ? "nothing" : text) + ", expected " + kPositive.text() +
         ", or three with commas between them";
}

}  // namespace

ValueCheck pairText(std::string expected) {
  return [expected = std::move(expected)](const std::string& text) -> std::string {
    const std::size_t at = text.find('=');
    const bool isPair = at != std::string::npos && at > 0 && at + 1 < text.size();
    return isPair ? "" : foundText(text, expected);
  };
}

std::pair<int, int> pictureSize(const std::string& text) {
  constexpr int kLeastPixels = 16, kMostPixels = 4096;  // 1.6 GB of a picture's samples
  static const std::regex kSize("([0-9]{1,5})x([0-9]{1,5})");
  const auto fits = [](int pixels) { return pixels >= kLeastPixels && pixels <= kMostPixels; };
  std::smatch parts;
  if (std::regex_match(text, parts, kSize)) {
    const std::pair size(std::stoi(parts[1]), std::stoi(parts[2]));
    if (fits(size.first) && fits(size.second)) return size;
  }
  throw Error(ErrorKind::Usage, "--size: found " + formats::printable(text) +
                                    ", expected WxH with numbers from " +
                                    std::to_string(kLeastPixels) + " to " +
                                    std::to_string(kMostPixels) + ", such as 1000x800");
}

std::string placeFault(const std::string& text) {
  return coordinatesFault(text, kPlace);
}

Eigen::Vector3d placeIn(const std::string& text) {
  const std::vector<double> numbers = numbersIn(text, kInputPlace);
  return {numbers[0], numbers[1], numbers[2]};
}

const std::map<std::string, double>& millimetresByUnit() {
  static const std::map<std::string, double> units = {
      {"mm", 1}, {"cm", 10}, {"m", 1000}, {"um", 1e-3}, {"nm", 1e-6}};
  return units;
}

convert::ReadVolumeOptions VolumeArguments::options() const {
  convert::ReadVolumeOptions options;
  options.word = optionWord();
  options.series = series;
  options.skipFaulty = skipFaulty;
  options.fillGaps = fillGaps;
  options.grid = grid;
  if (const std::vector<double> mm = spacingIn(spacing); !mm.empty())
    options.spacing = Eigen::Vector3d(mm.front(), mm[mm.size() / 2], mm.back());
  if (const auto mm = millimetresByUnit().find(unit); mm != millimetresByUnit().end())
    options.unit = mm->second;
  options.allowedDetached.assign(allowDetached.begin(), allowDetached.end());
  if (crop.size() == 6) {
    constexpr int kBeyondVolumes = 1 << 30;  // beyond every volume, and not where sizes overflow
    const auto at = [&](std::size_t i) {
      return std::clamp(crop[i], -kBeyondVolumes, kBeyondVolumes - 1);
    };
    options.crop = convert::CellBox::between({at(0), at(2), at(4)}, {at(1), at(3), at(5)});
  }
  if (volumeIndex) options.volumeIndex = static_cast<int>(*volumeIndex);
  return options;
}

convert::SeedReading TrackArguments::reading() const {
  convert::SeedReading reading;
  reading.word = optionWord();
  if (const auto system = kSeedSystems.find(seedsFrame); system != kSeedSystems.end())
    reading.system = system->second;
  if (const auto unit = millimetresByUnit().find(seedsUnit); unit != millimetresByUnit().end())
    reading.unit = unit->second;
  return reading;
}

operations::VesselOptions TrackArguments::vessels() const {
  operations::VesselOptions vessels;
  vessels.track = options;
  vessels.seedsName = seeds.name();
  vessels.isSeedsOnly = isSeedsOnly;
  for (const std::string& text : roots) vessels.roots.push_back(placeIn(text));
  vessels.isOnlyConnected = isOnlyConnected;
  return vessels;
}

void addVolumeRows(OptionTable& table, VolumeArguments& volume) {
  table.group("Volume");
  table.scope(kVolumes);
  table
      .add("series", &volume.series, "ID",
           "DICOM series: its instance UID, or its number in the list that is printed when a "
           "folder holds several")
      .forInputs(kDicom);
  table
      .flag("fill-gaps", volume.fillGaps,
            "Interpolate slices that are missing from a DICOM series, and those between slices of "
            "several distances")
      .forInputs(kDicom);
  table
      .add(kOption.volumeIndex.name, &volume.volumeIndex, "N",
           "Volume of a file that holds several, such as a 4-D NIfTI, or of a DICOM series; the "
           "first "
           "is 0")
      .in(WholeRange{})
      .forInputs(kVolumes);
  OptionRow& crop = table.add(kOption.crop.name, &volume.crop, "I0,I1,J0,J1,K0,K1",
                              "Keep this box of voxel indices only, ends included");
  crop.in(WholeRange{});
  crop.count = 6;
  crop.delimiter = ',';
  table
      .add("spacing", &volume.spacing, "MM or MM,MM,MM",
           "Distance of voxels along i, j and k, or of all, in mm, whatever the file states")
      .checkedBy(spacingFault);
  table
      .add(kOption.unit.name, &volume.unit, "UNIT",
           "Unit of the lengths in a volume's header, a mesh or a centerline: mm, cm, m, um or nm, "
           "whatever the file states")
      .among(wordsOf(millimetresByUnit()))
      .forInputs(kFileVolumes | kMeshes | kCenterline);
  table
      .add("allow-detached", &volume.allowDetached, "PATH",
           "Allow a header to take its voxels, or a scene its mesh, from this file, or from below "
           "this folder; otherwise only from its own folder. May be given several times")
      .checkedBy(fileName())
      .many()
      .forInputs(kFileVolumes | kScene);
  table.scope(kAnyContent);
  table.group("");
}

void addVolumeRows(OptionTable& table, VolumeArguments& volume, const std::string& file) {
  const std::size_t before = table.rows().size();
  addVolumeRows(table, volume);
  for (std::size_t i = before; i < table.rows().size(); ++i) table.rows()[i].onlyWith(file);
}

void addNativeRow(OptionTable& table, InputFile& native) {
  table
      .file("native", native,
            "Computed tomography of the same body without contrast; its grid and place may be "
            "others. Each of its bones is registered alone and subtracted, so that vessels in bone "
            "are found and bone is not")
      .forInputs(kImage);
}

void addTrackRows(OptionTable& table, TrackArguments& track) {
  table.scope(kImage);
  table.group("Tracking");
  table.file(
      kOption.seeds.name, track.seeds,
      "Hints on the vessels that are found (name, parent, kind, inlet), and starts of others: "
      "lumen's seeds JSON, or points of 3D Slicer (.mrk.json, .fcsv) [none]");
  table
      .add("seeds-frame", &track.seedsFrame, "FRAME",
           "Frame of the seeds' coordinates, whatever their file states: lps, ras, or voxel "
           "(indices; radii in the file's unit)")
      .among(wordsOf(kSeedSystems))
      .onlyWith(kOption.seeds.name);
  table
      .add(
          "seeds-unit", &track.seedsUnit, "UNIT",
          "Unit of the seeds' positions and radii, whatever their file states: mm, cm, m, um or nm")
      .among(wordsOf(millimetresByUnit()))
      .onlyWith(kOption.seeds.name);
  table
      .add(
          kOption.root.name, &track.roots, "X,Y,Z",
          "Place near the end of a vessel through which blood comes in, mm, LPS [the widest end of "
          "each tree]. May be given several times")
      .checkedBy(inputPlaceFault)
      .many()
      .forInputs(kImage | kLabels | kMeshes | kCenterline);
  table
      .flag("only-connected", track.isOnlyConnected,
            "Leave out trees in which no seed and no root lies")
      .forInputs(kImage | kLabels | kMeshes | kCenterline)
      .onlyWith(kOption.seeds.name)
      .onlyWith("root");
  table
      .flag("seeds-only", track.isSeedsOnly,
            "Track from the seeds alone, instead of taking them as hints on the vessels that are "
            "found without them")
      .onlyWith(kOption.seeds.name);
  track.options.addRows(table);
  table
      .add("repeat", &track.repeats, "N",
           "Track N times more, with other random numbers, a tenth of the noise added and clicks "
           "moved by a tenth of a voxel, and report how much of each vessel is found again [0]. "
           "Takes N times longer")
      .in(WholeRange{0, 1000});
  table.scope(kAnyContent);
  table.group("");
}

void addMeshRows(OptionTable& table, MeshArguments& mesh) {
  table.group("Surface");
  table.scope(kMeshes);
  table.file(
      "centerline", mesh.centerline,
      "Centerline of a mesh: .vtp or .vtk with VMTK's arrays, .swc, .tre or curves of 3D Slicer "
      "(.mrk.json, or a folder of them), or another that lumen convert reads [found inside of the "
      "mesh]");
  table
      .add("centerline-frame", &mesh.centerlineFrame, "FRAME",
           "Axes of --centerline: lps, or ras, whose x and y are negated [as its file states, or "
           "those of the mesh]")
      .among(kPatientFrames)
      .onlyWith("centerline");
  table
      .add("centerline-unit", &mesh.centerlineUnit, "UNIT",
           "Unit of --centerline: mm, cm, m, um or nm [as its file states, or that of the mesh]")
      .among(wordsOf(millimetresByUnit()))
      .onlyWith("centerline");
  table
      .add("mesh", &mesh.sceneMesh, "NAME",
           "Mesh of a scene that the vessels are: the name of its loader or of the loader's node "
           "[the one whose node has vessel in its name, or that does not move]")
      .forInputs(kScene);
  table.scope(kAnyContent);
  table.group("");
}

void addLabelTableRows(OptionTable& table, MaskArguments& mask) {
  table
      .file(
          "label-table", mask.labelTable,
          "Names of the labels: a file of nnU-Net, BIDS, ITK-SNAP, FreeSurfer or 3D Slicer, a JSON "
          "object, comma-separated values, or a table that comes with lumen, such as "
          "totalsegmentator or topcow [those in the header of the map, or in a file beside it]")
      .without("labels");
  table
      .add("role", &mask.roles, "LABEL=ROLE",
           "Role of a label, by its name or number: " + alternatives(convert::roleWords()) +
               " [as its table or its name shows]. May be given several times")
      .checkedBy(roleFault)
      .many()
      .forInputs(kVolumes);
}

void addLabelMapRows(OptionTable& table, MaskArguments& mask) {
  table
      .file(
          "label-map", mask.labelMaps,
          "Volume of labels that name branches and state what is a vessel or none, or a folder of "
          "one for each structure; its grid may be another. May be given several times: the "
          "first that "
          "has a label counts")
      .many()
      .forInputs(kVolumes)
      .without("labels");
  addLabelTableRows(table, mask);
  table.find("role")->onlyWith("label-map");
  table
      .flag("only-labelled", mask.isOnlyLabelled,
            "Leave out vessels on no label of the maps, but those that lead to one on a label")
      .forInputs(kVolumes)
      .onlyWith("label-map");
}

void addMaskRows(OptionTable& table, MaskArguments& mask) {
  table.group("Surface");
  table.scope(kLabels);
  table.flag("mask", mask.isMask,
             "The volume holds labels, and all but 0 are vessels; it needs no seeds");
  table.add("label", &mask.label, "N", "The volume holds labels, and this one alone is of vessels")
      .in(WholeRange{1, 1 << 24})
      .without("mask");
  table
      .add("labels", &mask.labels, "LIST",
           "The volume holds labels, and these are of vessels, such as 1=ica,2=mca; branches get "
           "their names")
      .without("mask")
      .without("label");
  table.scope(kVolumes);
  addLabelMapRows(table, mask);
  table.scope(kAnyContent);
  table.group("");
}

void addFitRows(OptionTable& table, convert::FitOptions& fit) {
  table.scope(kFitted, kModelled);
  fit.addRows(table);
  table.scope(kAnyContent);
  table.group("");
}

void addEncodingRows(OptionTable& table, formats::EncodeOptions& encoding) {
  table.group("Case file");
  table.scope(kAnyContent, kBinaryCase);
  table.flag("compress", encoding.compress,
             "Compress the chunks of a .lumen file with zstd; they can no longer be used in place");
  table
      .add("point-bits", &encoding.pointBits, "N",
           "Round wall points to N bits in their bounding box, 1 to 30 [exact]")
      .in(WholeRange{1, 30})
      .defaults("")
      .forInputs(kVolumes | kMeshes | kCases)
      .forOutputs(kBinaryCase | kJsonCase);
  table.scope(kAnyContent);
  table.group("");
}

void addFormatRow(OptionTable& table, const std::string& name, std::string& value,
                  const std::string& argument) {
  table.group("");
  table.add(name, &value, "F", "Format of " + argument + ", whatever its name");
}

namespace {

constexpr const char* kTime = "time";
constexpr NumberRange kTimes{-1e9, 1e9};  // s: some thirty years

}  // namespace

OptionRow& addTimeRow(OptionTable& table, std::optional<double>& time) {
  return table
      .add(kTime, &time, "S",
           "Take the case as it stands at this time of its motion, in s; without it, at rest")
      .in(kTimes);
}

formats::Case atTime(formats::Case value, const std::optional<double>& time,
                     const std::string& file, const OptionTable& table, Progress& progress) {
  if (!time) return value;
  if (!value.motion) {
    refuseUnused(*table.find(kTime),
                 "is for cases with a motion, and " + formats::printable(file) + " has none",
                 progress);
    return value;
  }
  try {
    return convert::posedCase(value, *time, progress);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::InvalidInput) throw;
    throw invalidInput(file + ": " + error.what());
  }
}

}  // namespace lumen::engine
