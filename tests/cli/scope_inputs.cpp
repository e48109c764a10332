// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/scope_inputs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <sstream>

#include <nlohmann/json.hpp>

#include "converters/io/volume/write_volume.h"
#include "tests/unit/native/two_bones.h"
#include "tests/unit/volume/dicom_fixture.h"

namespace lumen::test {

namespace fs = std::filesystem;
using engine::RunContext;

namespace {

constexpr std::size_t kEdge = 32;              // voxels of the volumes
constexpr std::size_t kNiftiHeader = 352;      // bytes
constexpr std::size_t kSlice = kEdge * kEdge;  // voxels
constexpr std::size_t kVoxels = kEdge * kEdge * kEdge;

/// The name of the other half's label in `halves.nii`.
std::string withTwoHalves(std::string nifti) {
  for (std::size_t i = kVoxels / 2; i < kVoxels; ++i) {
    char& label = nifti[nifti.size() - kVoxels + i];
    if (label == 1) label = 2;
  }
  return nifti;
}

/// Two NIfTI files of one volume as one of two.
std::string withTwoTimes(std::string first, const std::string& second) {
  first[40] = 4;  // dim[0], and dim[4], a little-endian number of 16 bits
  first[48] = 2;
  return first + second.substr(kNiftiHeader);
}

/// A slice of a NIfTI volume of 16 bits as a file of DICOM.
std::string dicomOf(const std::string& nifti, std::size_t slice, const std::string& series) {
  using convert::DicomSlice;
  DicomSlice made;
  made.series = series;
  made.columns = made.rows = static_cast<int>(kEdge);
  made.spacing = "0.2\\0.2";
  made.number = static_cast<int>(slice) + 1;
  made.position = "0\\0\\" + std::to_string(0.2 * static_cast<double>(slice));
  std::string pixels = nifti.substr(kNiftiHeader + 2 * slice * kSlice, 2 * kSlice);
  for (std::size_t i = 0; i < pixels.size(); i += 2)  // no number below 0 is read there
    if ((pixels[i + 1] & 0x80) != 0) pixels[i] = pixels[i + 1] = 0;
  made.pixelElement = DicomSlice::tag(0x7fe0, 0x10) + "OW" + DicomSlice::raw<std::uint16_t>(0) +
                      DicomSlice::raw(static_cast<std::uint32_t>(pixels.size())) + pixels;
  made.bitsUsed = 15;
  return made.bytes();
}

std::string headerOf(const std::string& voxels) {
  return "NRRD0004\ntype: int16\ndimension: 3\nspace: left-posterior-superior\nsizes: 32 32 32\n"
         "space directions: (0.2,0,0) (0,0.2,0) (0,0,0.2)\nspace origin: (0,0,0)\n"
         "kinds: domain domain domain\nendian: little\nencoding: raw\nbyte skip: -1\n"
         "data file: " +
         voxels + "\n";
}

/// A ball of soft tissue in air, as CT has them, of 40 x 40 x 40 voxels of 1 mm with a little noise.
std::string scanOfBall() {
  constexpr int kSize = 40;
  std::string file =
      "NRRD0004\ntype: int16\ndimension: 3\nspace: left-posterior-superior\nsizes: 40 40 40\n"
      "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nendian: little\n"
      "encoding: raw\n\n";
  unsigned noise = 1;
  for (int z = 0; z < kSize; ++z)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        noise = noise * 1103515245U + 12345U;
        const double away = std::hypot(x - 20.0, y - 20.0, z - 20.0);
        const double inside = std::clamp(13.5 - away, 0.0, 1.0);
        const auto value = static_cast<std::int16_t>(-1000 + std::lround(1040 * inside) +
                                                     static_cast<int>((noise >> 16) % 13) - 6);
        file.append(reinterpret_cast<const char*>(&value), sizeof value);
      }
  return file;
}

std::string sceneOf(const std::string& folder) {
  return "<Node name=\"root\">\n<Node name=\"Arteries\"><MeshSTLLoader name=\"loader\" "
         "filename=\"" +
         folder +
         "plain.stl\"/></Node>\n<Node name=\"Tip\"><MeshSTLLoader name=\"tip\" filename=\"" +
         folder + "two.stl\"/></Node>\n</Node>\n";
}

/// The case, in which one node was moved and made wider by hand.
std::string withCorrection(const std::string& text) {
  nlohmann::json value = nlohmann::json::parse(text);
  const nlohmann::json& tree = value["tree"];
  const std::size_t node = tree["centre"].size() / 2;
  const nlohmann::json at = tree["centre"][node];
  const nlohmann::json request = {
      {"op", "move"},
      {"node",
       {{"label", tree["branches"][0]["label"]}, {"at", at}, {"radius", tree["radius"][node]}}},
      {"position", at},
      {"radius", 1.3 * tree["radius"][node].get<double>()}};
  value["metadata"]["steps"].push_back(
      {{"name", "edit"},
       {"tool", "test"},
       {"parameters", {{"0001", "moved a node"}, {"0001-request", request.dump()}}}});
  return value.dump();
}

/// The case, whose nodes move by 0.5 mm along x and turn within a second, and grow by a tenth.
std::string withMotion(const std::string& text) {
  nlohmann::json value = nlohmann::json::parse(text);
  const nlohmann::json& centres = value["tree"]["centre"];
  nlohmann::json motion = {{"time", {0, 1}}, {"node", nlohmann::json::array()}};
  for (const char* const key : {"centre", "rotation", "factor"})
    motion[key] = {nlohmann::json::array(), nlohmann::json::array()};
  for (std::size_t i = 0; i < centres.size(); ++i) {
    nlohmann::json moved = centres[i];
    moved[0] = moved[0].get<double>() + 0.5;
    motion["node"].push_back(i);
    motion["centre"][0].push_back(centres[i]);
    motion["centre"][1].push_back(moved);
    motion["rotation"][0].push_back({0, 0, 0, 1});
    motion["rotation"][1].push_back({0, 0, 0.6, 0.8});
    motion["factor"][0].push_back(1);
    motion["factor"][1].push_back(1.1);
  }
  value["version"] = "1.2";
  value["motion"] = motion;
  return value.dump();
}

constexpr const char* kSamples = R"(convert
  --series 1 --fill-gaps true --volume-index 1 --crop 2,29,2,29,2,29 --spacing 0.21 --unit cm --allow-detached .
  --native plain.nrrd --frame ras --seeds seeds.json --seeds-frame ras --seeds-unit cm --root 3.1,3.1,5.8
  --only-connected true --seeds-only true --dark true --inlier-rate 0.6 --inlier-band 0.12
  --rays 42 --axes 21 --samples 64 --min-trials 100 --max-trials 400 --step 0.4
  --noise-margin 1.5 --look-ahead 2 --branch-offset 1.5 --aneurysm-gradient 0.4
  --point-spread 0.1 --smoothing 0.17 --even-blur false --max-nodes 1000 --random-seed 2
  --repeat 1 --corrections corrected.lumen.json --centerline truth.swc --centerline-frame ras
  --centerline-unit cm --mesh Arteries --mask true --label 1 --labels 1=artery
  --label-map halves.nii --label-table table.csv --role 1=bone --only-labelled true --kernel gaussian --kernel-parameter 0.3
  --cohesion-weight 1e-4 --curvature-weight 1e-2 --cohesion-scale 3 --max-subdivisions 2
  --neighbourhood 1 --seam-sweeps 1 --seam-weight 32 --iso-level 0.15 --accuracy 0.5
  --max-distance 30 --min-width 0.03 --edge 0.4r --extend 2r --thickness 0.2r --touching apart
  --max-error 0.05 --triangles 500 --edge-min 0.6 --edge-max 0.08 --gap 0.3 --open true --patches true --cell 0.3
  --lod 2 --mesh-per branch --colour radius --meshopt true --draco true
  --draco-position-bits 12 --draco-normal-bits 8 --stl-solids true --compress true
  --point-bits 12 --time 0.5 --skin false --layers 2 --growth 1.6 --layer-height 0.02r
  --accept seen --out out/accepted.lumen
)";

}  // namespace

bool isRefusal(const std::string& message) {
  for (const char* const words : {" is for ", " does nothing with", " exclude one another"})
    if (message.find(words) != std::string::npos) return true;
  return false;
}

std::vector<Trial> trialsOf(const std::string& lines) {
  std::vector<Trial> trials;
  std::istringstream text(lines);
  for (std::string line; std::getline(text, line);) {
    std::istringstream stream(line);
    const std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
    if (words.empty()) continue;
    const bool isFurther = line.front() == ' ';
    std::size_t next = 0;
    if (!isFurther) {
      trials.push_back({{words[next++], {}, {}}, {}});
      if (words[0] == "library") trials.back().operation.name += " " + words.at(next++);
    }
    Trial& trial = trials.back();
    while (next < words.size()) {
      const std::string& word = words[next++];
      if (!word.starts_with("--"))
        trial.operation.arguments.push_back(word);
      else if (isFurther)
        trial.tried.emplace_back(word.substr(2), words.at(next++));
      else
        trial.operation.with(word.substr(2), words.at(next++));
    }
  }
  return trials;
}

const std::string& sampleOf(const std::string& option) {
  static const Given samples = trialsOf(kSamples).front().tried;
  static const std::string none;
  for (const auto& [name, value] : samples)
    if (name == option) return value;
  return none;
}

void ScopeTest::SetUp() {
  fillOnce("scope", [this] {
    makeVolumes();
    makeDicom();
    makeSurfaces();
  });
  m_hasDicom = lumen({"info", "series", "--series", "1"}).code == 0;
  m_before = fs::current_path();
  fs::current_path(path(""));
}

void ScopeTest::TearDown() {
  fs::current_path(m_before);
}

void ScopeTest::makeVolumes() const {
  make({"phantom", "tube", "tube.nrrd", "--size", "32", "--truth", "truth.lumen", "--seeds",
        "seeds.json"});
  make({"phantom", "kissing", "two.nrrd", "--size", "32", "--seeds", "two.json"});
  write("apart.swc", "1 0 0 0 0 .6 -1\n2 0 6 0 0 .6 1\n3 0 0 3 0 .6 -1\n4 0 6 3 0 .6 3\n");
  make({"phantom", "--tree", "apart.swc", "apart.nrrd", "--seeds", "apart.json"});
  write("scan.nrrd", scanOfBall());
  for (const auto& [name, scan] : {std::pair("cta.nrrd", convert::withContrast()),
                                   std::pair("plain.nrrd", convert::withoutContrast())})
    write(name, convert::encodeVolume(scan.draw(), convert::VolumeFormat::Nrrd, true, name));
  nlohmann::json clicks = nlohmann::json::parse(read("apart.json"));
  clicks["branches"].erase(1);
  write("one.json", clicks.dump());
  make({"convert", "tube.nrrd", "case.lumen", "--seeds", "seeds.json"});
  make({"convert", "case.lumen", "corrected.lumen.json"});
  write("corrected.lumen.json", withCorrection(read("corrected.lumen.json")));
  make({"convert", "two.nrrd", "two.lumen", "--seeds", "two.json"});
  make({"track", "tube.nrrd", "tracked.lumen", "--seeds", "seeds.json"});
  for (const char* const name : {"case", "tracked"}) {
    const std::string moving = "moving-" + std::string(name) + ".lumen.json";
    make({"convert", std::string(name) + ".lumen", moving});
    write(moving, withMotion(read(moving)));
  }
  make({"check", "tube.nrrd", "case.lumen", "--mask", "labels.nrrd"});
  make({"check", "tube.nrrd", "case.lumen", "--mask", "whole.nii"});
  make({"convert", "apart.nrrd", "apart.lumen"});
  make({"check", "apart.nrrd", "apart.lumen", "--mask", "apart-labels.nrrd"});
  make({"convert", "apart.nrrd", "one.lumen", "--seeds", "one.json", "--seeds-only"});
  make({"check", "apart.nrrd", "one.lumen", "--mask", "one-label.nrrd"});
  write("halves.nii", withTwoHalves(read("whole.nii")));
}

void ScopeTest::makeDicom() const {
  make({"phantom", "tube", "tube.nii", "--size", "32"});
  make({"phantom", "kissing", "two.nii", "--size", "32"});
  const std::string tube = read("tube.nii"), two = read("two.nii");
  write("times.nii", withTwoTimes(tube, two));
  fs::create_directories(path("header"));
  write("tube.raw", tube.substr(kNiftiHeader));
  write("header/tube.nhdr", headerOf("../tube.raw"));
  fs::create_directories(path("series"));
  fs::create_directories(path("gapped"));
  for (std::size_t k = 0; k < kEdge; ++k) {
    write("series/a" + std::to_string(k) + ".dcm", dicomOf(tube, k, "1.2.3.1"));
    write("series/b" + std::to_string(k) + ".dcm", dicomOf(two, k, "1.2.3.2"));
    if (k != 9) write("gapped/a" + std::to_string(k) + ".dcm", dicomOf(tube, k, "1.2.3.1"));
  }
}

void ScopeTest::makeSurfaces() const {
  make({"convert", "case.lumen", "plain.stl"});
  make({"convert", "two.lumen", "two.stl"});
  make({"convert", "apart.lumen", "apart.stl"});
  make({"convert", "truth.lumen", "truth.swc"});
  write("ends.swc",
        "1 0 0 0 0 1.5 -1\n2 0 0 0 2 1.5 1\n3 0 0 0 4 1.5 2\n4 0 0 0 6 1.5 3\n5 0 0 0 8 1.5 4\n"
        "6 0 0 0 10 1.5 5\n7 0 0 0 12 1.2 6\n8 0 3 0 5 0.3 3\n9 0 6 0 6 0.3 8\n"
        "10 0 9 0 7 0.3 9\n11 0 0 2 8 1 5\n12 0 0 4 8 1 11\n");
  make({"convert", "ends.swc", "ends.lumen"});
  write("table.csv", "value,name\n1,ica\n2,mca\n");
  write("vessels.scn", sceneOf(""));
  write("header/vessels.scn", sceneOf("../"));
  fs::copy_file(path("truth.lumen"), path("tree.lumen"));
}

Operation ScopeTest::operationOf(const std::string& command, std::vector<std::string> arguments,
                                 const Given& options) {
  Operation operation{command, std::move(arguments), {}};
  for (const auto& [name, value] : options) operation.with(name, value);
  return operation;
}

Operation ScopeTest::withOption(Operation operation,
                                const std::pair<std::string, std::string>& option) {
  std::erase_if(operation.options, [&](const auto& one) { return one.first == option.first; });
  return operation.with(option.first, option.second);
}

Effect ScopeTest::effectOf(const Operation& operation,
                           const std::vector<std::string>& folders) const {
  fs::remove_all("out");
  fs::create_directory("out");
  for (const std::string& folder : folders)
    fs::copy(folder, "out/" + folder, fs::copy_options::recursive);
  Progress progress;
  Effect effect;
  try {
    const engine::Answer answer = m_engine.run(operation, RunContext{m_engine, progress});
    effect.answer = answer.json.dump() + answer.text + std::to_string(answer.code);
  } catch (const std::exception& error) {
    effect.error = error.what();
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator("out"))
    if (entry.is_regular_file() && entry.path().filename() != "lumen-export.json")
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) effect.files += file.string() + read(file.string());
  return effect;
}

}  // namespace lumen::test
