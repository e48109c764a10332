// SPDX-License-Identifier: Apache-2.0
// Surroundings of the page: a browser, connections that end, the program's own end, sizes.
#include <atomic>
#include <cstdlib>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "converters/base/error.h"
#include "served.h"
#include "viewer/server/browser.h"
#include "viewer/server/http_server.h"
#include "viewer/session/packs/case_pack.h"
#include "viewer/session/packs/pack.h"

namespace lumen::test {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;

using BoundsTest = ServedTest;
using TrackFurtherTest = ServedTest;

TEST(IdleTimeout, IsAMinuteAfterTheLastPageAndItsWork) {
  const auto start = viewer::IdleTimeout::Clock::now();
  viewer::IdleTimeout idle(seconds(60), start);
  EXPECT_FALSE(idle.isOver(0, false, start + seconds(1000)));  // nobody has come yet
  EXPECT_FALSE(idle.isOver(1, false, start + seconds(1001)));
  EXPECT_FALSE(idle.isOver(0, false, start + seconds(1061)));  // it may be loaded again
  EXPECT_FALSE(idle.isOver(0, true, start + seconds(1062)));
  EXPECT_FALSE(idle.isOver(0, false, start + seconds(1122)));
  EXPECT_FALSE(idle.isOver(1, false, start + seconds(1123)));
  EXPECT_TRUE(idle.isOver(0, false, start + milliseconds(1183001)));
}

class BrowserTest : public ServedTest {
protected:
  void SetUp() override { m_before = std::getenv("PATH"); }
  void TearDown() override { setenv("PATH", m_before.c_str(), 1); }

private:
  std::string m_before;
};

TEST_F(BrowserTest, GetsTheAddressAsOneWord) {
  write("xdg-open", "#!/bin/sh\nprintf '%s %s' \"$#\" \"$1\" >'" + path("address").string() +
                        ".part'\nmv '" + path("address").string() + ".part' '" +
                        path("address").string() + "'\n");
  fs::permissions(path("xdg-open"), fs::perms::owner_all);
  setenv("PATH", (folder.string() + ":" + std::getenv("PATH")).c_str(), 1);
  const std::string address = "http://127.0.0.1:1/a;touch b $(c)/";
  ASSERT_TRUE(viewer::openBrowser(address));
  while (!fs::exists(path("address"))) std::this_thread::sleep_for(milliseconds(5));
  std::ifstream written(path("address"));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(written), {}), "1 " + address);
}

TEST_F(BrowserTest, IsNoneWhereNothingOpensAddresses) {
  setenv("PATH", folder.c_str(), 1);
  EXPECT_FALSE(viewer::openBrowser("http://127.0.0.1:1/"));
}

namespace {

/// A server of its own, whose only answer is what `work` does while somebody waits.
class Waiting {
public:
  explicit Waiting(const std::function<void(Progress&)>& work) {
    m_http.Get("/", [work](const httplib::Request& request, httplib::Response&) {
      viewer::whileConnected(request.remote_port, work);
    });
    m_port = m_http.bind_to_any_port("127.0.0.1");
    m_thread = std::thread([this] { m_http.listen_after_bind(); });
  }
  ~Waiting() {
    m_http.stop();
    m_thread.join();
  }
  [[nodiscard]] int ask(milliseconds patience) const {
    httplib::Client client("127.0.0.1", m_port);
    client.set_read_timeout(patience);
    const auto result = client.Get("/");
    return result ? result->status : 0;
  }

private:
  httplib::Server m_http;
  int m_port = 0;
  std::thread m_thread;
};

}  // namespace

TEST(Connection, WorkEndsWhenNobodyWaitsForIt) {
  std::atomic<bool> cancelled{false};
  const Waiting server([&cancelled](Progress& progress) {
    const auto end = std::chrono::steady_clock::now() + seconds(60);
    while (!progress.cancelled() && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(milliseconds(5));
    cancelled = progress.cancelled();
  });
  EXPECT_EQ(server.ask(milliseconds(300)), 0);
  for (int i = 0; i < 6000 && !cancelled; ++i) std::this_thread::sleep_for(milliseconds(10));
  EXPECT_TRUE(cancelled);
}

TEST(Connection, WorkGoesOnWhileSomebodyWaits) {
  std::atomic<bool> cancelled{true};
  const Waiting server([&cancelled](Progress& progress) {
    std::this_thread::sleep_for(milliseconds(700));  // three looks
    cancelled = progress.cancelled();
  });
  EXPECT_EQ(server.ask(seconds(60)), 200);
  EXPECT_FALSE(cancelled);
}

TEST_F(BoundsTest, ADroppedFileBeyondTheBoundIsRefused) {
  session = std::make_unique<viewer::Session>(viewer::SessionOptions{});
  serveSession({.mostFile = 1000});
  const auto status = [this](std::size_t size) {
    auto result =
        client().Post(root + "file?name=a.obj", std::string(size, ' '), "application/octet-stream");
    if (result && result->status != 200) {
      EXPECT_EQ(Json::parse(result->body)["error"], "at most 1000 bytes are taken here");
    }
    return result ? result->status : 0;
  };
  EXPECT_EQ(status(1000), 200);  // taken, and then no mesh
  waitForJob();
  EXPECT_EQ(status(1001), 400);
  EXPECT_NE(status(1 << 20), 200);  // the connection may be closed before all of it was sent
  EXPECT_TRUE(state()["job"].is_null());
}

TEST_F(TrackFurtherTest, ASecondClickAddsAVesselAndLeavesTheFirstAsItIs) {
  convert::Volume volume = convert::drawVolume(64, 0.2, [](const Eigen::Vector3d& p) {
    return std::min(convert::capsule(p, {3.2, 6.4, 0.4}, {3.2, 6.4, 12.2}, 1.0),
                    convert::capsule(p, {9.6, 6.4, 0.4}, {9.6, 6.4, 12.2}, 1.0));
  });
  writeVolume("tubes.nrrd", volume);
  serve({"tubes.nrrd"});
  const auto click = [this](const std::string& label, double x) {
    ASSERT_EQ(
        perform({{"op", "seed_add"}, {"label", label}, {"points", {{{"position", {x, 6.4, 6.4}}}}}})
            .status,
        200);
    performAll({{"op", "track"}, {"labels", {label}}});
  };
  click("first", 3.2);
  const ReadPack one(get("case").body);
  ASSERT_EQ(one.json["branches"].size(), 1U);
  click("second", 9.6);
  const ReadPack two(get("case").body);
  ASSERT_EQ(two.json["branches"].size(), 2U);
  EXPECT_EQ(two.json["branches"][1]["label"], "second");
  EXPECT_EQ(two.json["has_models"], true);
  auto centre = two.array<float>("centre");
  centre.resize(one.array<float>("centre").size());
  EXPECT_EQ(centre, one.array<float>("centre"));
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(ReadPack(get("case").body).json["branches"].size(), 1U);
}

namespace {

/// A coded array, as the page decodes it.
std::vector<std::uint32_t> stored(const ReadPack& pack, const std::string& name) {
  const Json& place = pack.json["arrays"][name];
  const std::size_t rows = place["shape"][0],
                    columns = place["shape"].size() > 1 ? place["shape"][1].get<std::size_t>() : 1,
                    size = place["stored"] == "u16" ? 2 : 4;
  std::vector<std::uint32_t> values(rows * columns);
  std::size_t at = pack.base + place["offset"].get<std::size_t>();
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t k = 0; k < size; ++k)
      for (std::size_t i = c; i < values.size(); i += columns)
        values[i] |= std::uint32_t{static_cast<unsigned char>(pack.bytes.at(at++))} << (8 * k);
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (place["coding"] == "back")
      next = std::max(next, (values[i] = next - values[i]) + 1);
    else if (i >= columns)
      values[i] = (values[i] + values[i - columns]) & (size == 2 ? 0xffff : 0xffffffff);
  return values;
}

}  // namespace

namespace {

/// Notes the stages, and that nobody is warned.
class NotedProgress : public Progress {
public:
  void begin(std::string_view stage, std::size_t) override { stages.insert(std::string(stage)); }
  void warn(std::string_view message) override { ADD_FAILURE() << message; }
  std::set<std::string> stages;
};

}  // namespace

TEST(Surfaces, ALevelThatSomebodyWaitsForIsMadeAloneAndItsStagesAreReported) {
  viewer::Session session({});
  const fs::path file =
      fs::temp_directory_path() / ("lumen-waited-" + std::to_string(getpid()) + ".lumen");
  ASSERT_TRUE(formats::writeCaseFile(twoVessels(), file));
  NotedProgress noted;
  session.open({file, "two.lumen"}, noted);
  fs::remove(file);
  noted.stages.clear();
  const auto fine = session.finishedSurface(0, noted);
  ASSERT_TRUE(fine.bytes);
  const ReadPack pack(*fine.bytes);
  EXPECT_EQ(pack.json["kind"], "closed");
  EXPECT_EQ(pack.json["level"], 0);
  EXPECT_TRUE(noted.stages.contains("triangles"));
  // what is ready is better than a preview or a coarser level, for which no time is taken
  EXPECT_EQ(session.surfacePack(0, true).tag, fine.tag);
  EXPECT_EQ(session.surfacePack(1, false).tag, fine.tag);
  noted.cancel();
  EXPECT_THROW(session.finishedSurface(1, noted), Error);
}

TEST(CompactPack, HasTheSameTrianglesInTheSamePartsWithinItsSteps) {
  viewer::Session session({});
  const fs::path file =
      fs::temp_directory_path() / ("lumen-compact-" + std::to_string(getpid()) + ".lumen");
  ASSERT_TRUE(formats::writeCaseFile(twoVessels(), file));
  Progress silent;
  session.open({file, "two.lumen"}, silent);
  fs::remove(file);
  const std::string full = *session.surfacePack(0, true).bytes;
  const ReadPack before(full), after(viewer::compactPack(full));
  EXPECT_EQ(after.json["parts"], before.json["parts"]);
  const auto position = before.array<float>("position"), radius = before.array<float>("radius_mm");
  const auto node = before.array<std::uint32_t>("node"),
             triangle = before.array<std::uint32_t>("triangle");
  const auto p = stored(after, "position"), n = stored(after, "node"),
             t = stored(after, "triangle"), r = stored(after, "radius_mm");
  ASSERT_EQ(t.size(), triangle.size());
  // a triangle by its corners in place of their numbers, turned to begin with the least
  using Corner = std::array<long, 5>;
  const auto sorted = [](std::size_t count, const auto& corner, const Json& parts) {
    std::vector<std::vector<Corner>> all;
    for (const Json& part : parts)
      for (std::size_t i = part["first"];
           i < part["first"].get<std::size_t>() + part["count"].get<std::size_t>(); ++i) {
        EXPECT_LT(i, count);
        std::vector<Corner> c{corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)};
        std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
        all.push_back(c);
        all.back().push_back({part["first"].get<long>()});
      }
    std::sort(all.begin(), all.end());
    return all;
  };
  const Json& places = after.json["arrays"];
  const auto steps = [&places](const char* name, std::size_t column, double value) {
    return std::lround((value - places[name]["low"][column].get<double>()) /
                       places[name]["step"][column].get<double>());
  };
  const auto was = sorted(
      triangle.size() / 3,
      [&](std::size_t i) -> Corner {
        const std::uint32_t v = triangle[i];
        return {steps("position", 0, position[3 * v]), steps("position", 1, position[3 * v + 1]),
                steps("position", 2, position[3 * v + 2]), steps("radius_mm", 0, radius[v]),
                node[v]};
      },
      before.json["parts"]);
  const auto is = sorted(
      t.size() / 3,
      [&](std::size_t i) -> Corner {
        const std::uint32_t v = t[i];
        return {p.at(3 * v), p.at(3 * v + 1), p.at(3 * v + 2), r.at(v), n.at(v)};
      },
      after.json["parts"]);
  EXPECT_EQ(was, is);
  EXPECT_LT(viewer::deflated(after.bytes).size(), full.size() / 3);
}

}  // namespace lumen::test
