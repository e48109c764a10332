// SPDX-License-Identifier: Apache-2.0
// The volumes of `lumen export grid`, read by ITK from a folder.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <nlohmann/json.hpp>

#include "../surface/closed_cases.h"
#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/export/targets/grid/grid.h"
#include "kissing.h"

namespace lumen::test {

using namespace convert;
namespace fs = std::filesystem;

namespace {

using Image = itk::Image<float, 3>;

/// A trunk along x, a side along y that ends in z: no two axes are alike.
formats::Case landmarkCase() {
  formats::Case result;
  result.metadata.voxelSize = 0.2;
  addVessel(result, "trunk", straightPath({-7, 3, 20}, {1, 0, 0}, 20), 1.0, 1.0);
  addVessel(result, "side", straightPath({0, 4.5, 20}, {0, 1, 0}, 8), 0.8, 1.0, 7);
  addVessel(result, "top", straightPath({0, 11.5, 21.2}, {0, 0, 1}, 5), 0.6, 1.0, 27);
  addModels(result);
  return result;
}

class GridFiles : public testing::Test {
protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "lumen-grid-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    m_folder = name;
  }
  void TearDown() override { fs::remove_all(m_folder); }

  ExportResult write(const formats::Case& source, double spacing, const GridOptions& grid = {},
                     LengthUnit unit = LengthUnit::Millimetre) {
    CommonOptions options;
    options.spacing = spacing;
    Progress silent;
    ExportResult result = exportGrid({source, options, {unit, Axes::Lps}, silent}, grid);
    for (const ExportFile& file : result.files)
      std::ofstream(m_folder / file.name, std::ios::binary) << file.bytes;
    return result;
  }

  template <class Io>
  Image::Pointer read(const std::string& name) {
    const auto reader = itk::ImageFileReader<Image>::New();
    reader->SetImageIO(Io::New());
    reader->SetFileName((m_folder / name).string());
    reader->Update();
    return reader->GetOutput();
  }

  fs::path m_folder;
};

/// The least distance to the balls of the nodes.
double toBalls(const VesselDistance& vessels, const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < vessels.tree().nodeCount(); ++n)
    least = std::min(least, (p - toEigen(vessels.tree().centre[n])).norm() -
                                static_cast<double>(vessels.tree().radius[n]));
  return least;
}

/// Every sample of both images is what the field says at the place that ITK gives it, in LPS.
void expectField(const Image& distance, const Image& branch, const VesselDistance& vessels) {
  const auto region = distance.GetLargestPossibleRegion();
  ASSERT_EQ(region, branch.GetLargestPossibleRegion());
  std::mt19937 random(7);
  std::set<float> branches;
  for (int k = 0; k < 4000; ++k) {
    Image::IndexType index;
    for (unsigned a = 0; a < 3; ++a)
      index[a] = static_cast<itk::IndexValueType>(random() % region.GetSize(a));
    itk::Point<double, 3> p, q;
    distance.TransformIndexToPhysicalPoint(index, p);
    branch.TransformIndexToPhysicalPoint(index, q);
    ASSERT_LT((p - q).GetNorm(), 1e-9);
    const WallDistance truth = askAll(vessels, {p[0], p[1], p[2]});
    // a NIfTI header holds places in floats, of 2e-6 mm at 20 mm; far from walls the search of one point may end at another wall
    // than the nearest, which is about that of the nearest ball of a node, or a round end; forks bulge
    const double sample = distance.GetPixel(index), single = truth.distance;
    const double nearest =
        single < 2 ? single : std::min(single, toBalls(vessels, {p[0], p[1], p[2]}));
    ASSERT_LT(sample, single + (single < 2 ? 1e-4 : 0.1)) << p;
    ASSERT_GT(sample, nearest - (single < 2 ? 1e-4 : 0.2)) << p;
    if (std::abs(truth.distance) < 1e-4F) continue;
    ASSERT_EQ(branch.GetPixel(index), truth.distance < 0 ? truth.branch + 1 : 0) << p;
    branches.insert(branch.GetPixel(index));
  }
  EXPECT_EQ(branches, (std::set<float>{0, 1, 2, 3}));
}

}  // namespace

TEST_F(GridFiles, DoNotDependOnNamesInTheFolderOfTemporaries) {
  const fs::path folder = m_folder / "temporaries";
  for (const char* name : {"volume.nrrd", "volume.nii", "volume.mha"})
    fs::create_directories(folder / name);
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before != nullptr ? before : "";
  setenv("TMPDIR", folder.c_str(), 1);
  EXPECT_NO_THROW(write(landmarkCase(), 1, {.formats = {GridFormat::Nrrd, GridFormat::Nifti}}));
  before != nullptr ? setenv("TMPDIR", kept.c_str(), 1) : unsetenv("TMPDIR");
  EXPECT_TRUE(fs::exists(m_folder / "distance.nii.gz"));
}

TEST_F(GridFiles, AreReadByItkAtTheirPlaces) {
  const formats::Case source = landmarkCase();
  write(source, 0.35, {.formats = {GridFormat::Nrrd, GridFormat::Nifti, GridFormat::Mhd}});
  const VesselDistance vessels(source);
  expectField(*read<itk::NrrdImageIO>("distance.nrrd"), *read<itk::NrrdImageIO>("branch.nrrd"),
              vessels);
  expectField(*read<itk::NiftiImageIO>("distance.nii.gz"),
              *read<itk::NiftiImageIO>("branch.nii.gz"), vessels);
  expectField(*read<itk::MetaImageIO>("distance.mhd"), *read<itk::MetaImageIO>("branch.mhd"),
              vessels);
}

TEST_F(GridFiles, NameTheirBranches) {
  const formats::Case source = landmarkCase();
  write(source, 0.5);
  const Image::Pointer image = read<itk::NrrdImageIO>("branch.nrrd");
  std::string label;
  ASSERT_TRUE(itk::ExposeMetaData(image->GetMetaDataDictionary(), "lumen.branch.2", label));
  EXPECT_EQ(label, "side");
  std::ifstream in(m_folder / "branches.json");
  const auto table = nlohmann::json::parse(in);
  ASSERT_EQ(table["branches"].size(), 3U);
  EXPECT_EQ(table["branches"][2]["value"], 3);
  EXPECT_EQ(table["branches"][2]["label"], "top");
}

TEST_F(GridFiles, OfEachBranchAreSamplesOfTheOneGridThatKeepWhatTouchesApart) {
  const formats::Case source = kissingCase(0.02);
  write(source, 0.2);
  write(source, 0.2, {.perBranch = true});
  const Image::Pointer merged = read<itk::NrrdImageIO>("distance.nrrd"),
                       wide = read<itk::NrrdImageIO>("wide.distance.nrrd"),
                       narrow = read<itk::NrrdImageIO>("narrow.distance.nrrd");
  const auto at = [](const Image& image, double y) {
    itk::Point<double, 3> p;
    p[0] = 10;
    p[1] = y;
    p[2] = 0;
    return image.GetPixel(image.TransformPhysicalPointToIndex(p));
  };
  EXPECT_LT(at(*merged, 0), -0.7);
  EXPECT_LT(at(*merged, 1.62), -0.4);
  EXPECT_LT(at(*wide, 0), -0.7);
  EXPECT_GT(at(*wide, 1.62), 0.4);
  EXPECT_LT(at(*narrow, 1.62), -0.4);
  EXPECT_GT(at(*narrow, 0.2), 0.4);
  EXPECT_LT(narrow->GetLargestPossibleRegion().GetNumberOfPixels(),
            merged->GetLargestPossibleRegion().GetNumberOfPixels());
  // the same lattice: a sample of one lies on a sample of the other
  itk::Point<double, 3> p;
  narrow->TransformIndexToPhysicalPoint({{3, 4, 5}}, p);
  itk::ContinuousIndex<double, 3> index;
  ASSERT_TRUE(merged->TransformPhysicalPointToContinuousIndex(p, index));
  for (unsigned a = 0; a < 3; ++a) EXPECT_NEAR(index[a], std::round(index[a]), 1e-6);
}

TEST_F(GridFiles, HoldAnAneurysmAlone) {
  for (const bool perBranch : {false, true}) {
    const ExportResult result = write(sphereCase(2, 2.5), 0.3, {.perBranch = perBranch});
    const std::string name = perBranch ? "sphere.distance.nrrd" : "distance.nrrd";
    const Image::Pointer image = read<itk::NrrdImageIO>(name);
    itk::Point<double, 3> p;
    p[0] = p[1] = p[2] = 0.05;
    EXPECT_LT(image->GetPixel(image->TransformPhysicalPointToIndex(p)), -1);
    EXPECT_TRUE(result.ends.empty());
  }
}

TEST_F(GridFiles, RefuseWhatTheirFormatsCannotHold) {
  const formats::Case source = landmarkCase();
  const auto kindOf = [&](double spacing, const GridOptions& grid, LengthUnit unit) {
    try {
      write(source, spacing, grid, unit);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::Failed;
  };
  EXPECT_EQ(kindOf(0.5, {}, LengthUnit::Metre), ErrorKind::Usage);
  EXPECT_EQ(kindOf(0.001, {}, LengthUnit::Millimetre), ErrorKind::Usage);
}

TEST_F(GridFiles, HaveTheSameBytesAgain) {
  const formats::Case source = landmarkCase();
  const GridOptions options{.formats = {GridFormat::Nrrd, GridFormat::Nifti, GridFormat::Cdf},
                            .band = 1};
  const ExportResult one = write(source, 0.5, options), two = write(source, 0.5, options);
  ASSERT_EQ(one.files.size(), two.files.size());
  for (std::size_t i = 0; i < one.files.size(); ++i)
    EXPECT_EQ(one.files[i].bytes, two.files[i].bytes) << one.files[i].name;
}

}  // namespace lumen::test
