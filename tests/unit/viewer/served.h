// SPDX-License-Identifier: Apache-2.0
// A session and its server in this process, and what a page would ask of them.
#pragma once

#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <stdlib.h>

#include "../mesh/synthetic.h"
#include "../tracking/tube_volume.h"
#include "converters/io/volume/write_volume.h"
#include "formats/case/case_encoding.h"
#include "formats/case/case_file.h"
#include "viewer/routes/html_page.h"
#include "viewer/server/server.h"

// behind Eigen: <resolv.h>, which it includes, has a macro that is a name there
#include <httplib.h>

namespace lumen::test {

using viewer::Json;

/// A tube of radius 1 mm through the middle of a volume of 12.8 mm, and a click on its axis.
inline convert::Volume tubeVolume() {
  return convert::drawVolume(64, 0.2, [](const Eigen::Vector3d& p) {
    return convert::capsule(p, {6.4, 6.4, 0.4}, {6.4, 6.4, 12.2}, 1.0);
  });
}

/// Two vessels with models, apart from each other.
inline formats::Case twoVessels() {
  formats::Case value;
  value.metadata.voxelSize = 0.2;
  addVessel(value, "left", straightPath({0, 0, 0}, {1, 0, 0}, 8), 1.0, 1.0);
  addVessel(value, "right", straightPath({0, 10, 0}, {1, 0, 0}, 6), 0.8, 1.0);
  addModels(value);
  return value;
}

/// The case as a file.
inline std::string bytesOf(const formats::Case& value) {
  const std::vector<std::byte> bytes = formats::encodeBinary(value);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A page, each file of which holds its own name.
inline viewer::PageFiles smallPage() {
  return {{"", {"text/html; charset=utf-8", "<!doctype html><title>page</title>"}},
          {"page.js", {"text/javascript; charset=utf-8", "'use strict';/*</script><!--*/"}},
          {"page.css", {"text/css; charset=utf-8", "body{color:red}"}}};
}

/// The contents of a pack.
struct ReadPack {
  Json json;
  std::string bytes;
  std::size_t base = 0;

  explicit ReadPack(std::string text) : bytes(std::move(text)) {
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data(), 4);
    base = 4 + size;
    json = Json::parse(bytes.substr(4, size));
  }
  template <class T>
  [[nodiscard]] std::vector<T> array(const std::string& name) const {
    const Json& place = json["arrays"][name];
    std::size_t count = 1;
    for (const Json& n : place["shape"]) count *= n.get<std::size_t>();
    std::vector<T> values(count);
    const std::size_t begin = base + place["offset"].get<std::size_t>();
    EXPECT_LE(begin + count * sizeof(T), bytes.size());
    EXPECT_EQ(begin % 8, 0U);
    std::memcpy(values.data(), bytes.data() + begin, count * sizeof(T));
    return values;
  }
};

/// While it lives there is no folder for temporary files: whoever asks for it fails.
class NoTemporaryFolder {
public:
  NoTemporaryFolder() {
    if (const char* const named = std::getenv("TMPDIR")) m_before = named;
    setenv("TMPDIR", "/nowhere/at/all", 1);
  }
  ~NoTemporaryFolder() {
    if (m_before)
      setenv("TMPDIR", m_before->c_str(), 1);
    else
      unsetenv("TMPDIR");
  }
  NoTemporaryFolder(const NoTemporaryFolder&) = delete;
  NoTemporaryFolder& operator=(const NoTemporaryFolder&) = delete;

private:
  std::optional<std::string> m_before;
};

class ServedTest : public ::testing::Test {
protected:
  ServedTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "lumen-served-XXXXXX").string();
    folder = mkdtemp(pattern.data());
  }
  ~ServedTest() override {
    server.reset();
    session.reset();
    std::filesystem::remove_all(folder);
  }

  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder / name; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  void writeCase(const std::string& name, const formats::Case& value) const {
    ASSERT_TRUE(formats::writeCaseFile(value, path(name)));
  }
  void writeVolume(const std::string& name, const convert::Volume& volume) const {
    write(name, convert::encodeVolume(volume, convert::VolumeFormat::Nrrd, false, name));
  }
  void writeTube(const std::string& name) const { writeVolume(name, tubeVolume()); }

  /// Opens files of the folder and serves them; the first case is the one that is saved.
  void serve(const std::vector<std::string>& names) {
    server.reset();
    session = std::make_unique<viewer::Session>(viewer::SessionOptions{});
    Progress silent;
    for (const std::string& name : names) {
      session->open({path(name), name}, silent);
      if (name.ends_with(".lumen")) session->saving.saveTo(path(name));
    }
    serveSession();
  }

  void serveSession(const viewer::ServerOptions& options = {}) {
    server = std::make_unique<viewer::Server>(*session, smallPage(), options);
    const std::string address = server->address();
    const auto slash = address.find('/', 7);
    authority = address.substr(7, slash - 7);
    root = address.substr(slash);
  }

  [[nodiscard]] httplib::Client client() const {
    httplib::Client made("http://" + authority);
    made.set_read_timeout(120);
    return made;
  }
  [[nodiscard]] httplib::Response get(const std::string& name,
                                      const httplib::Headers& headers = {}) const {
    auto result = client().Get(root + name, headers);
    EXPECT_TRUE(result) << name;
    return result ? *result : httplib::Response{};
  }
  [[nodiscard]] httplib::Response post(const std::string& name, const std::string& body) const {
    auto result = client().Post(root + name, body, "application/json");
    EXPECT_TRUE(result) << name;
    return result ? *result : httplib::Response{};
  }
  [[nodiscard]] Json state() const { return Json::parse(get("state").body); }
  /// An operation at the revision that the document has.
  [[nodiscard]] httplib::Response perform(Json request) const {
    request["revision"] = state()["revision"];
    return post("do", request.dump());
  }
  /// Performs an operation at the document's revision and waits for the end of its job.
  void performAll(const Json& request) const {
    const auto response = perform(request);
    ASSERT_EQ(response.status, 200) << response.body;
    waitForJob();
  }
  void waitForJob() const {
    while (!state()["job"].is_null()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }

  std::filesystem::path folder;
  std::unique_ptr<viewer::Session> session;
  std::unique_ptr<viewer::Server> server;
  std::string authority, root;  ///< "127.0.0.1:40123", "/TOKEN/"
};

}  // namespace lumen::test
