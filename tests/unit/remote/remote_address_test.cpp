// SPDX-License-Identifier: Apache-2.0
#include "converters/io/remote/remote_address.h"

#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"

namespace lumen::convert {

namespace {

std::string refusal(const std::string& text) {
  try {
    (void)parseRemote(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage) << text;
    return error.what();
  }
  return "taken";
}

std::string nameIn(const std::string& text) {
  return parseRemote(text).fileName();
}

}  // namespace

TEST(RemoteAddress, IsKnownByItsScheme) {
  for (const char* text : {"http://a/b", "https://a/b", "HTTPS://a/b", "s3://a/b"})
    EXPECT_TRUE(isRemote(text)) << text;
  for (const char* text :
       {"", "a.nrrd", "file:///etc/passwd", "ftp://a/b", "https:/a/b", "/https://a/b"})
    EXPECT_FALSE(isRemote(text)) << text;
}

TEST(RemoteAddress, ShowsNoQuery) {
  const RemoteAddress address = parseRemote("https://host/a/head.nrrd?X-Amz-Signature=secret#top");
  EXPECT_EQ(address.text, "https://host/a/head.nrrd?X-Amz-Signature=secret");
  EXPECT_EQ(address.shown(), "https://host/a/head.nrrd");
}

TEST(RemoteAddress, ItsFileNameStaysInItsFolder) {
  EXPECT_EQ(nameIn("https://host/a/head.nii.gz?x=/y"), "head.nii.gz");
  EXPECT_EQ(nameIn("https://host/a/Kopf%20CT.nrrd"), "Kopf CT.nrrd");
  EXPECT_EQ(nameIn("https://host/a/%2e%2e%2fpasswd"), "_passwd");
  EXPECT_EQ(nameIn("https://host/a/.."), "file");
  EXPECT_EQ(nameIn("https://host/a/-rf"), "rf");
  EXPECT_EQ(nameIn("https://host/a/b/"), "b");
  EXPECT_EQ(nameIn("https://host/a%"), "a%");
  EXPECT_EQ(nameIn("s3://bucket/key%20one"), "key%20one");
}

TEST(RemoteAddress, FilesBelowKeepTheQuery) {
  EXPECT_EQ(parseRemote("https://host/lib/?k=1").below("data/a/case.lumen").text,
            "https://host/lib/data/a/case.lumen?k=1");
}

TEST(RemoteAddress, IsRefusedWithTheReason) {
  EXPECT_NE(refusal("https://me:word@host/a").find("https://...@host: "), std::string::npos);
  EXPECT_EQ(refusal("https://me:word@host/a").find("word@"), std::string::npos);
  for (const char* text :
       {"https://", "https://host", "https://host/", "https:///a", "s3://bucket", "s3://bucket/"})
    EXPECT_NE(refusal(text).find("expected "), std::string::npos) << text;
  for (const char* text : {"https://host/a b", "https://host/a\nb", "https://host/{a,b}"})
    EXPECT_NE(refusal(text).find("%XX"), std::string::npos) << text;
  EXPECT_EQ(refusal("s3://bucket/a b"), "taken");
}

}  // namespace lumen::convert
