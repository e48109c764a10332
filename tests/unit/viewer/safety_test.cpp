// SPDX-License-Identifier: Apache-2.0
// Requests that get an answer, and those that get none.
#include <atomic>

#include <netinet/in.h>
#include <sys/socket.h>

#include "served.h"
#include "viewer/server/http_server.h"

namespace lumen::test {

class SafetyTest : public ServedTest {
protected:
  void SetUp() override {
    writeCase("two.lumen", twoVessels());
    serve({"two.lumen"});
  }

  /// Status and body of a raw request, of which every byte is given.
  [[nodiscard]] httplib::Response at(const std::string& target,
                                     const httplib::Headers& headers = {}) const {
    auto result = client().Get(target, headers);
    return result ? *result : httplib::Response{};
  }
};

TEST_F(SafetyTest, TheTokenHas128BitsAndIsAnotherOneEachTime) {
  EXPECT_EQ(root.size(), 34U);
  EXPECT_EQ(root.substr(1, 32).find_first_not_of("0123456789abcdef"), std::string::npos);
  const std::string first = root;
  server.reset();
  serve({"two.lumen"});
  EXPECT_NE(root, first);
}

TEST(Token, IsTheSameOnlyIfEveryByteIs) {
  const std::string secret = viewer::randomToken();
  EXPECT_TRUE(viewer::sameSecret(secret, std::string(secret)));
  for (std::size_t i = 0; i < secret.size(); ++i) {
    std::string other = secret;
    other[i] = other[i] == '0' ? '1' : '0';
    EXPECT_FALSE(viewer::sameSecret(secret, other)) << i;
  }
  EXPECT_FALSE(viewer::sameSecret(secret, secret.substr(1)));
  EXPECT_FALSE(viewer::sameSecret(secret, ""));
}

TEST_F(SafetyTest, WithoutTheTokenThereIsNothingNotEvenABody) {
  std::string wrong = root;
  wrong[5] = wrong[5] == '0' ? '1' : '0';
  for (const std::string& target :
       {std::string("/"), std::string("/state"), wrong, wrong + "state", root.substr(0, 33),
        std::string("//"), root.substr(0, 20) + "/state"}) {
    const auto response = at(target);
    EXPECT_EQ(response.status, 404) << target;
    EXPECT_EQ(response.body, "") << target;
  }
}

TEST_F(SafetyTest, ANameThatWasReboundToThisMachineIsNoHost) {
  for (const char* const host : {"evil.example", "localhost", "127.0.0.1", "127.0.0.1:1"}) {
    const auto response = at(root + "state", {{"Host", host}});
    EXPECT_EQ(response.status, 404) << host;
    EXPECT_EQ(response.body, "");
  }
  EXPECT_EQ(at(root + "state", {{"Host", authority}}).status, 200);
}

TEST_F(SafetyTest, PagesOfOtherOriginsAreRefused) {
  for (const std::string& origin :
       {std::string("http://evil.example"), std::string("null"), "https://" + authority,
        "http://" + authority + ".evil.example"}) {
    EXPECT_EQ(at(root + "state", {{"Origin", origin}}).status, 404) << origin;
    auto result = client().Post(root + "do", {{"Origin", origin}}, "{}", "application/json");
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, 404) << origin;
  }
  EXPECT_EQ(at(root + "state", {{"Origin", "http://" + authority}}).status, 200);
}

TEST_F(SafetyTest, OnlyOneAddressOfTheLoopbackInterfaceIsListenedOn) {
  httplib::Client other("http://127.0.0.2" + authority.substr(authority.find(':')));
  EXPECT_FALSE(other.Get(root + "state"));
}

TEST_F(SafetyTest, EveryAnswerForbidsWhatThePageDoesNotNeed) {
  for (const char* const name : {"", "state", "page.js", "case", "nothing"}) {
    const auto response = get(name);
    const std::string policy = response.get_header_value("Content-Security-Policy");
    EXPECT_TRUE(policy.starts_with("default-src 'none'; script-src 'self' 'wasm-unsafe-eval';"));
    EXPECT_EQ(policy.find("unsafe-inline"), std::string::npos);
    EXPECT_EQ(policy.find("http"), std::string::npos);
    EXPECT_EQ(response.get_header_value("X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(response.get_header_value("Referrer-Policy"), "no-referrer");
    EXPECT_EQ(response.get_header_value("Cache-Control"), "no-store");
    EXPECT_EQ(response.get_header_value("X-Frame-Options"), "DENY");
    EXPECT_EQ(response.get_header_value("Cross-Origin-Resource-Policy"), "same-origin");
  }
}

TEST_F(SafetyTest, NoPathLeadsToAFile) {
  write("secret.txt", "secret");
  for (const std::string& name :
       {std::string("../secret.txt"), std::string("..%2f..%2fetc%2fpasswd"),
        "%2e%2e/" + path("secret.txt").string(), path("secret.txt").string(),
        std::string("page.js/../../etc/passwd"), std::string("two.lumen")}) {
    const auto response = get(name);
    EXPECT_EQ(response.status, 404) << name;
    EXPECT_EQ(response.body, "") << name;
  }
}

TEST_F(SafetyTest, TheNameOfADroppedFileIsALabelAndNoPath) {
  write("here.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string name = path("here.obj").string();
  const auto response = post("file?name=" + name, "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  ASSERT_EQ(response.status, 200) << response.body;
  waitForJob();
  const Json now = state();
  ASSERT_EQ(now["meshes"].size(), 1U);
  EXPECT_EQ(now["meshes"][0]["name"], name);
  const ReadPack pack(get("mesh?id=" + now["meshes"][0]["id"].dump()).body);
  EXPECT_EQ(pack.array<float>("position").at(7), 2);  // the bytes that came, not those of the file
  std::ifstream file(path("here.obj"));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}),
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
}

TEST_F(SafetyTest, RequestsAreBoundedInSizeAndDepth) {
  EXPECT_EQ(post("do", std::string((1 << 20) + 1, ' ')).status, 400);
  EXPECT_EQ(post("do", std::string(100000, '[')).status, 400);
  EXPECT_EQ(post("do", "{").status, 400);
  EXPECT_EQ(post("do", "[]").status, 400);
  EXPECT_EQ(state()["revision"], 2);  // nothing has happened since the file was opened
}

TEST_F(SafetyTest, AFormInSeveralPartsIsRefusedInASentence) {
  for (const char* const name : {"do", "vessel_at_click", "cancel", "file?name=a.obj"}) {
    auto result = client().Post(
        root + name, httplib::MultipartFormDataItems{{"file", "v 0 0 0", "a.obj", "text/plain"}});
    ASSERT_TRUE(result) << name;
    EXPECT_EQ(result->status, 400) << name;
    EXPECT_EQ(Json::parse(result->body)["error"],
              "the body must be plain, not a form in several parts");
  }
}

TEST_F(SafetyTest, AnUnknownOptionOfADownloadIsRefusedInASentence) {
  for (const std::string name : {"help", "config", "no-such"}) {
    const auto response = get("save?format=glb&" + name + "=");
    EXPECT_EQ(response.status, 400);
    EXPECT_EQ(Json::parse(response.body)["error"], "\"" + name + "\" is no option of a download");
  }
}

TEST_F(SafetyTest, AnOptionThatADownloadWouldIgnoreIsRefusedByName) {
  for (const auto& [query, sentence] : std::vector<std::pair<std::string, std::string>>{
           {"obj&draco",
            "--draco is for writing glTF (.glb, .gltf), and the format obj is none of "},
           {"glb&cell=0.1", "--cell does nothing without --patches"},
           {"glb&draco&meshopt", "exclude one another"},
           {"swc&edge=0.5r", "--edge is for writing meshes"}}) {
    const auto response = get("save?format=" + query);
    EXPECT_EQ(response.status, 400) << query;
    EXPECT_NE(response.body.find(sentence), std::string::npos) << response.body;
  }
}

TEST_F(SafetyTest, EdgesThatWouldFillTheMemoryAreRefused) {
  for (const char* const query : {"glb&edge=1e-9", "stl&edge=1e-9r", "obj&edge-max=1e-9"}) {
    const auto response = get(std::string("save?format=") + query);
    EXPECT_EQ(response.status, 400) << query;
    EXPECT_NE(response.body.find("the surface would have about "), std::string::npos)
        << response.body;
  }
}

TEST_F(SafetyTest, SlowSendersDoNotLockThePageOut) {
  constexpr int kSenders = 200;
  const int port = std::stoi(authority.substr(authority.find(':') + 1));
  std::vector<int> sockets;
  for (int i = 0; i < kSenders; ++i) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<std::uint16_t>(port));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    sockets.push_back(socket(AF_INET, SOCK_STREAM, 0));
    ASSERT_EQ(connect(sockets.back(), reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
  }
  std::atomic<bool> stop{false};
  std::thread senders([&sockets, &stop] {
    const std::string head = "GET / HTTP/1.1\r\nX: " + std::string(1000, 'a');
    for (std::size_t i = 0; !stop && i < head.size(); ++i) {
      for (const int one : sockets) send(one, &head[i], 1, MSG_NOSIGNAL);
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(get("state").status, 200);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(15));
  stop = true;
  senders.join();
  for (const int one : sockets) close(one);
}

TEST_F(SafetyTest, NumbersFromThePageAreChecked) {
  for (const char* const request :
       {R"({"op": "rename", "branch": 2, "label": "x"})",
        R"({"op": "rename", "branch": -1, "label": "x"})",
        R"({"op": "rename", "branch": 1e3, "label": "x"})", R"({"op": "rename", "branch": 0})",
        R"({"op": "seed_add", "points": [{"position": [1, 2]}]})",
        R"({"op": "seed_add", "points": [{"position": [1, 2, 1e300]}]})",
        R"({"op": "seed_add", "points": []})", R"({"op": "unheard"})"}) {
    const auto response = perform(Json::parse(request));
    EXPECT_EQ(response.status, 400) << request;
    EXPECT_TRUE(Json::parse(response.body)["error"].is_string());
  }
  EXPECT_EQ(get("surface?level=-1").status, 400);
  EXPECT_EQ(get("mesh?id=99999999999999999999").status, 400);
  EXPECT_EQ(get("save?format=/etc/passwd").status, 400);
  EXPECT_EQ(get("save?format=glb&config=/etc/passwd").status, 400);
}

TEST_F(SafetyTest, ManyPagesLeaveRoomForRequests) {
  std::atomic<int> listening{0}, refused{0};
  std::vector<std::thread> pages;
  std::atomic<bool> stop{false};
  for (int i = 0; i < 17; ++i)
    pages.emplace_back([&] {
      bool counted = false;
      auto result = client().Get(
          root + "events",
          [&](const httplib::Response& response) {
            if (response.status == 503) ++refused;
            return response.status == 200;
          },
          [&](const char*, std::size_t) {
            if (!counted) ++listening;
            counted = true;
            return !stop;
          });
    });
  while (listening + refused < 17) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(listening, 16);
  EXPECT_EQ(refused, 1);
  EXPECT_EQ(get("state").status, 200);
  stop = true;
  session->events.close();
  for (std::thread& page : pages) page.join();
}

TEST(HtmlPage, HasTheSameBytesWhateverElseTheProgramHasDone) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("lumen-same-" + std::to_string(getpid()) + ".lumen");
  ASSERT_TRUE(formats::writeCaseFile(twoVessels(), file));
  std::string first;
  for (int run = 0; run < 12; ++run) {
    viewer::Session session({});
    Progress silent;
    session.open({file, "two.lumen"}, silent);
    if (run % 2 == 1) session.finishedSurface(0, silent);  // another revision of the surface
    const std::string html = viewer::htmlPage(session, smallPage(), {}, silent);
    if (run == 0) first = html;
    EXPECT_EQ(html, first) << run;
  }
  std::filesystem::remove(file);
}

TEST(HtmlSafety, LabelsOfACaseCannotEndTheScriptThatTheyStandIn) {
  formats::Case value = twoVessels();
  value.tree.branches[0].label = "</script><img src=x onerror=alert(1)>";
  value.tree.branches[1].label = "<!--<script>";
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("lumen-html-" + std::to_string(getpid()) + ".lumen");
  ASSERT_TRUE(formats::writeCaseFile(value, file));
  viewer::Session session({});
  Progress silent;
  session.open({file, "<b>\"name\"</b>.lumen"}, silent);
  const std::string html = viewer::htmlPage(session, smallPage(), {}, silent);
  std::filesystem::remove(file);
  EXPECT_EQ(html.find("<img"), std::string::npos);
  EXPECT_EQ(html.find("<b>"), std::string::npos);
  EXPECT_EQ(html.find("<!--"), std::string::npos);
  // two elements, and both end where they should
  std::size_t opened = 0, closed = 0;
  for (std::size_t at = 0; (at = html.find("<script", at)) != html.npos; ++at) ++opened;
  for (std::size_t at = 0; (at = html.find("</script", at)) != html.npos; ++at) ++closed;
  EXPECT_EQ(opened, 2U);
  EXPECT_EQ(closed, 2U);
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(html.find("http://"), std::string::npos);
}

}  // namespace lumen::test
