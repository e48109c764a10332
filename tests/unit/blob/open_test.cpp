// SPDX-License-Identifier: Apache-2.0
// Models from files and bytes.
#include <cstring>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "blob.h"
#include "formats/case/case_file.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

formats::Vec3f vec(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

formats::BlobbyModels modelsOf(const Tree& tree) {
  formats::BlobbyModels models;
  models.kernel = static_cast<formats::Kernel>(tree.kernel);
  models.kernelParameter = tree.parameter;
  models.isoLevel = tree.level;
  models.offset = tree.offset;
  models.width = tree.blobWidth;
  for (const auto& c : tree.blobCentre) models.centre.push_back(vec(c));
  return models;
}

formats::Case caseOf(const Tree& tree) {
  formats::Case result;
  for (const auto& c : tree.centre) result.tree.centre.push_back(vec(c));
  const std::size_t count = tree.centre.size();
  result.tree.direction.assign(count, {1, 0, 0});
  result.tree.radius = tree.radius;
  result.tree.height.assign(count, 0.6f);
  result.tree.parent = tree.parent;
  result.tree.branch.assign(count, 0);
  formats::Branch branch;
  branch.label = "a";
  branch.nodeCount = static_cast<std::uint32_t>(count);
  result.tree.branches.push_back(branch);
  result.models = modelsOf(tree);
  return result;
}

struct Opened {
  blob_status status;
  Model model;
  std::string message;
};

Opened open(const void* bytes, std::size_t size, int verify = 1) {
  char message[300] = "";
  blob_open_def def = blob_open_def_default();
  def.verify = verify;
  def.message = message;
  def.message_size = sizeof message;
  blob_model* model = nullptr;
  const blob_status status = blob_model_open_bytes(bytes, size, &def, &model);
  return {status, Model(model), message};
}

double distanceAt(const Model& model, const Point& p, std::uint32_t flags = 0) {
  std::uint32_t cursor = BLOB_NOWHERE;
  blob_sample s;
  blob_query(model.get(), flags, p.data(), &cursor, &s);
  return s.distance;
}

TEST(BlobOpen, AFileGivesTheModelOfItsArrays) {
  const auto bytes = formats::encodeBinary(caseOf(tube(12)));
  const auto path = std::filesystem::temp_directory_path() / "lumen_blob_open_test.lumen";
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  blob_model* opened = nullptr;
  ASSERT_EQ(blob_model_open(path.c_str(), nullptr, &opened), BLOB_OK);
  const Model model(opened), created = tube(12).build();
  std::filesystem::remove(path);
  const Point p{3.2, 0.5, 0.1};
  EXPECT_EQ(distanceAt(model, p), distanceAt(created, p));
  EXPECT_EQ(blob_model_describe(opened).blob_count, 60U);
}

TEST(BlobOpen, BytesMayLieAnywhereAndGoAfterwards) {
  const auto bytes = formats::encodeBinary(caseOf(tube(12)));
  for (std::size_t shift = 0; shift < 9; ++shift) {
    std::vector<char> moved(bytes.size() + shift);
    std::memcpy(&moved[shift], bytes.data(), bytes.size());
    const Opened opened = open(&moved[shift], bytes.size());
    ASSERT_EQ(opened.status, BLOB_OK) << opened.message;
    std::fill(moved.begin(), moved.end(), '\xff');
    EXPECT_LT(distanceAt(opened.model, {3, 0, 0}), -0.9);
  }
}

TEST(BlobOpen, WhatIsMissingIsNamed) {
  blob_model* model = nullptr;
  EXPECT_EQ(blob_model_open("/no/such/file.lumen", nullptr, &model), BLOB_ERROR_FILE);
  EXPECT_EQ(blob_model_open("/", nullptr, &model), BLOB_ERROR_FILE);
  EXPECT_EQ(blob_model_open(nullptr, nullptr, &model), BLOB_ERROR_ARGUMENT);
  formats::Case tree = caseOf(tube(12));
  tree.models.reset();
  const auto bytes = formats::encodeBinary(tree);
  EXPECT_EQ(open(bytes.data(), bytes.size()).status, BLOB_ERROR_NO_MODELS);
}

TEST(BlobOpen, AFileThatCannotBeOpenedNamesTheCauseOnce) {
  const std::string empty = ::testing::TempDir() + "empty.lumen";
  std::fclose(std::fopen(empty.c_str(), "w"));
  const std::pair<std::string, std::string> causes[] = {
      {"/no/such/file.lumen", "No such file or directory"},
      {"/dev/null/file.lumen", "Not a directory"},
      {"/dev/null", "found a device or a pipe, expected a file"},
      {"/", "found a folder, expected a file"},
      {empty, "the file is empty"}};
  for (const auto& [file, cause] : causes) {
    char message[200] = "";
    blob_open_def def = blob_open_def_default();
    def.message = message;
    def.message_size = sizeof message;
    blob_model* model = nullptr;
    EXPECT_EQ(blob_model_open(file.c_str(), &def, &model), BLOB_ERROR_FILE) << file;
    EXPECT_EQ(message, cause);
  }
  std::remove(empty.c_str());
}

TEST(BlobOpen, ADamagedBodyIsAChecksumError) {
  auto bytes = formats::encodeBinary(caseOf(tube(12)));
  bytes[bytes.size() - 70] ^= std::byte{1};
  const Opened opened = open(bytes.data(), bytes.size());
  EXPECT_EQ(opened.status, BLOB_ERROR_CHECKSUM);
  EXPECT_NE(opened.message, "");
}

TEST(BlobOpen, ACompressedFileIsRefusedByName) {
  formats::EncodeOptions options;
  options.compress = true;
  const auto bytes = formats::encodeBinary(caseOf(tube(200)), options);
  const Opened opened = open(bytes.data(), bytes.size());
  EXPECT_EQ(opened.status, BLOB_ERROR_ENCODING);
  EXPECT_NE(opened.message.find("lumen convert"), std::string::npos) << opened.message;
}

// Without verification any bytes must still be refused or safe: every byte in turn is changed.
TEST(BlobOpen, UnverifiedDamageIsRefusedOrHarmless) {
  const auto bytes = formats::encodeBinary(caseOf(tube(4)));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::vector<std::byte> damaged = bytes;
    damaged[i] ^= std::byte{0xff};
    const Opened opened = open(damaged.data(), damaged.size(), 0);
    if (opened.status == BLOB_OK) distanceAt(opened.model, {1, 0.5, 0});
  }
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::vector<std::byte> prefix(bytes.begin(),
                                        bytes.begin() + static_cast<std::ptrdiff_t>(size));
    ASSERT_NE(open(prefix.data(), size, 0).status, BLOB_OK);
  }
}

TEST(BlobOpen, ATooSmallMessageBufferIsCutShort) {
  char message[8] = "xxxxxxx";
  blob_open_def def = blob_open_def_default();
  def.message = message;
  def.message_size = 4;
  blob_model* model = nullptr;
  EXPECT_EQ(blob_model_open_bytes("nonsense", 8, &def, &model), BLOB_ERROR_FORMAT);
  EXPECT_EQ(message[3], '\0');
  EXPECT_EQ(message[4], 'x');
}

}  // namespace
}  // namespace lumen::blob::test
