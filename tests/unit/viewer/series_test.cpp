// SPDX-License-Identifier: Apache-2.0
// Series of DICOM: dropped file by file, or a folder that was named.
#include "../volume/dicom_fixture.h"
#include "served.h"
#include "viewer/session/series_choice.h"

namespace lumen::test {

class SeriesTest : public ServedTest {
protected:
  /// Four slices 2 mm apart.
  [[nodiscard]] static std::vector<std::string> slices(const std::string& uid,
                                                       const std::string& description) {
    std::vector<std::string> files;
    convert::DicomSlice slice;
    slice.series = uid;
    slice.description = description;
    for (int n = 0; n < 4; ++n) {
      slice.number = n + 1;
      slice.first = 100 * n;
      slice.position = "0\\0\\" + std::to_string(2 * n);
      files.push_back(slice.bytes());
    }
    return files;
  }
  [[nodiscard]] int send(int batch, const std::string& name, const std::string& bytes) const {
    return post("series_file?batch=" + std::to_string(batch) + "&name=" + name, bytes).status;
  }
  /// Opens a series of the list that the state has.
  [[nodiscard]] Json request(int series) const {
    return {{"op", "open_series"}, {"series", series}, {"of", state()["revisions"]["series"]}};
  }
  void sendAll(int batch, const std::vector<std::string>& files) const {
    for (std::size_t n = 0; n < files.size(); ++n)
      ASSERT_EQ(send(batch, "IM" + std::to_string(n), files[n]), 200);
  }
};

TEST_F(SeriesTest, PagesThatSendAtOneTimeDoNotCutEachOther) {
  serve({});
  const std::vector<std::string> first = slices("1.2.1", "Angio"), other = slices("1.2.2", "Mask");
  for (std::size_t n = 0; n < first.size(); ++n) {
    ASSERT_EQ(send(111, "IM" + std::to_string(n), first[n]), 200);
    ASSERT_EQ(send(222, "IM" + std::to_string(n), other[n]), 200);
  }
  performAll({{"op", "list_series"}, {"batch", 111}});
  EXPECT_EQ(state()["title"], "Angio");
  EXPECT_EQ(ReadPack(get("volume").body).json["size"], (Json{4, 3, 4}));
  performAll({{"op", "list_series"}, {"batch", 222}});
  EXPECT_EQ(state()["title"], "Mask");
  EXPECT_EQ(ReadPack(get("volume").body).json["size"], (Json{4, 3, 4}));
}

TEST(SeriesChoiceTest, ABatchThatEndedForOthersIsRefusedAndNotCut) {
  viewer::SeriesChoice choice;
  const auto take = [&](std::int64_t batch, std::uint64_t bytes) {
    choice.take(batch, "IM", bytes, 100, [] { return std::string("x"); });
  };
  take(1, 40);
  take(2, 40);
  take(1, 20);  // now 2 waits longest
  take(3, 30);
  EXPECT_THROW(take(2, 1), viewer::Conflict);
  EXPECT_THROW((void)choice.end(2), viewer::Conflict);
  EXPECT_EQ(choice.end(1) != nullptr, true);
  EXPECT_THROW((void)choice.end(1), Error);
  EXPECT_THROW(take(4, 101), Error);
  EXPECT_EQ(choice.end(3) != nullptr, true);
}

TEST_F(SeriesTest, DroppedFilesAreListedAndOneSeriesIsOpened) {
  const NoTemporaryFolder none;
  serve({});
  sendAll(7, slices("1.2.1", "Angio"));
  sendAll(7, slices("1.2.2", "Mask"));  // of equal names, as from another folder
  EXPECT_EQ(send(7, "notes.txt", "a text"), 200);
  const std::string image = slices("1.2.1", "Angio")[0];
  EXPECT_EQ(send(7, "broken", image.substr(0, image.size() - 5)), 200);
  performAll({{"op", "list_series"}, {"batch", 7}});
  Json series = state()["series"];
  ASSERT_EQ(series["list"].size(), 2U);
  EXPECT_EQ(series["list"][1]["description"], "Mask");
  EXPECT_EQ(series["list"][1]["modality"], "CT");
  EXPECT_EQ(series["list"][1]["files"], 4);
  EXPECT_EQ(series["list"][1]["size"], (Json{4, 3, 4}));
  EXPECT_EQ(series["list"][1]["spacing_mm"], (Json{0.25, 0.5, 2.0}));
  EXPECT_TRUE(series["list"][1]["fault"].is_null());
  EXPECT_EQ(series["faulty"], 1);
  EXPECT_EQ(series["others"], 1);
  const std::string fault = series["faults"][0];
  EXPECT_TRUE(fault.starts_with("broken: ")) << fault;
  EXPECT_FALSE(state()["has_volume"]);
  const ReadPack picture(get("series_picture?series=1").body);
  EXPECT_EQ(picture.json["arrays"]["pixel"]["shape"], (Json{3, 4}));
  EXPECT_EQ(picture.array<std::uint8_t>("pixel").back(), 255);
  EXPECT_EQ(get("series_picture?series=2").status, 404);

  EXPECT_EQ(perform(request(2)).status, 400);
  performAll(request(1));
  EXPECT_EQ(state()["title"], "Mask");
  EXPECT_EQ(ReadPack(get("volume").body).json["size"], (Json{4, 3, 4}));
  EXPECT_EQ(state()["assumptions"].dump().find("broken"), std::string::npos);
  performAll(request(0));  // the files are still there
  EXPECT_EQ(state()["title"], "Angio");
  EXPECT_NE(state()["assumptions"].dump().find("broken"), std::string::npos);  // of this series
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(state()["title"], "Mask");
  ASSERT_EQ(perform({{"op", "close_series"}}).status, 200);
  EXPECT_TRUE(state()["series"].is_null());
}

TEST_F(SeriesTest, ANumberInAListIsNoSeriesOfTheListThatHasReplacedIt) {
  serve({});
  sendAll(7, slices("1.2.1", "Angio"));
  sendAll(7, slices("1.2.2", "Mask"));
  performAll({{"op", "list_series"}, {"batch", 7}});
  const Json seen = request(0);
  sendAll(9, slices("1.2.3", "Other"));
  sendAll(9, slices("1.2.4", "Fourth"));
  performAll({{"op", "list_series"}, {"batch", 9}});
  EXPECT_EQ(perform(seen).status, 409);
  performAll(request(0));
  EXPECT_EQ(state()["title"], "Other");
}

TEST_F(SeriesTest, TheOnlySeriesIsOpenedAtOnce) {
  serve({});
  sendAll(1, slices("1.2.1", ""));
  performAll({{"op", "list_series"}, {"batch", 1}});
  EXPECT_TRUE(state()["has_volume"]);
  EXPECT_EQ(state()["title"], "series 1");
}

TEST_F(SeriesTest, FilesWithoutSeriesChangeNothing) {
  serve({});
  EXPECT_EQ(send(3, "notes.txt", "a text"), 200);
  performAll({{"op", "list_series"}, {"batch", 3}});
  EXPECT_FALSE(state()["has_volume"]);
  EXPECT_TRUE(state()["series"].is_null());
  EXPECT_EQ(perform({{"op", "list_series"}, {"batch", 3}}).status, 400);  // it has ended
  EXPECT_EQ(perform({{"op", "list_series"}, {"batch", 4}}).status, 400);
}

TEST_F(SeriesTest, ABatchIsBounded) {
  session = std::make_unique<viewer::Session>(viewer::SessionOptions{});
  viewer::ServerOptions options;
  options.mostFile = 1000;
  serveSession(options);
  EXPECT_EQ(send(1, "a", std::string(600, 'x')), 200);
  EXPECT_EQ(send(1, "b", std::string(600, 'x')), 400);
  EXPECT_EQ(send(1, "c", std::string(400, 'x')), 200);
  EXPECT_EQ(send(2, "d", std::string(600, 'x')), 200);  // another batch
  EXPECT_EQ(post("series_file?batch=x&name=a", "x").status, 400);
  EXPECT_EQ(post("series_file?batch=1", "x").status, 400);
}

TEST_F(SeriesTest, AFolderOfSeveralSeriesIsOffered) {
  std::filesystem::create_directory(path("head"));
  for (const char* uid : {"1.2.1", "1.2.2"}) {
    const auto files = slices(uid, uid);
    for (std::size_t n = 0; n < files.size(); ++n)
      write("head/" + std::string(uid) + "-" + std::to_string(n), files[n]);
  }
  session = std::make_unique<viewer::Session>(viewer::SessionOptions{});
  Progress silent;
  ASSERT_TRUE(session->offerSeries(path("head"), silent));
  serveSession();
  EXPECT_EQ(state()["series"]["folder"], "head");
  performAll(request(1));
  EXPECT_EQ(state()["title"], "1.2.2");
  EXPECT_TRUE(state()["files"][0]["named"]);
  const int id = state()["files"][0]["id"];
  performAll({{"op", "reload"}, {"id", id}});  // of two series, the one that is open
  EXPECT_EQ(state()["title"], "1.2.2");
}

}  // namespace lumen::test
