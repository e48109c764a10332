// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/library/publish/signature.h"
#include "tests/unit/library/temporary_folder.h"

namespace lumen::convert {

namespace {

// of a key that was made for this test and is used nowhere
const std::string kPublic =
    "untrusted comment: minisign public key 4399E96D31EC718D\n"
    "RWSNcewxbemZQ25UeTL5oHtBrhmRV2EuLdlY1eRmmzTCIaWAcV1UKXaI\n";
const std::string kSignature =
    "untrusted comment: signature from minisign secret key\n"
    "RUSNcewxbemZQ4PfLFd56FKKV1uD6jkLxIIJ0+vVtj096Y+cwpLREnUqsV1or2Qikw2/"
    "rfoWMYEWuLJxUl3XIAqAIkSARXUTsQw=\n"
    "trusted comment: lumen\n"
    "yhRpxi26rX95l37P5JWUEQdUeq1cs40TyvuScwnu1bYrIw/Djd613AKiBkpVGAvXkBP3NLr8h4JIh1QGVJc+Cw==\n";
const std::string kOpenSsh =
    "ssh-ed25519 AAAAC3NzaC1lZDI1NTE5AAAAIC2DRT6gkuza766gUE3fd4MCBpntNDBuKBUandr+DNnr";

KeyFile keyOf(const std::string& text) {
  const TemporaryFolder files;
  files.write("key", text);
  return readKeyFile(files.path("key"));
}

}  // namespace

TEST(SignatureKey, IsKnownByItsContent) {
  EXPECT_EQ(keyOf(kPublic).kind, KeyKind::MinisignPublic);
  EXPECT_EQ(keyOf("-----BEGIN OPENSSH PRIVATE KEY-----\nx\n").kind, KeyKind::OpenSshPrivate);
  EXPECT_EQ(keyOf(kOpenSsh + " somebody@example.org\n").kind, KeyKind::OpenSshPublic);
  EXPECT_EQ(keyOf("# who\n\nwho@example.org " + kOpenSsh + "\n").kind, KeyKind::AllowedSigners);
  EXPECT_EQ(keyOf("who@example.org namespaces=\"a,b\" " + kOpenSsh + "\n").kind,
            KeyKind::AllowedSigners);
}

TEST(SignatureKey, HasTheIdThatMinisignPrints) {
  EXPECT_EQ(keyOf(kPublic).id, "4399E96D31EC718D");
  EXPECT_EQ(minisignSigner(kSignature), "4399E96D31EC718D");
}

TEST(SignatureKey, OfOpenSshLosesItsComment) {
  EXPECT_EQ(keyOf(kOpenSsh + " somebody@example.org\n").keys, std::vector<std::string>{kOpenSsh});
}

TEST(SignatureKey, IsRefusedIfItIsNone) {
  for (const char* const text :
       {"", "hello\n", "untrusted comment: x\n", "untrusted comment: x\nAAAA\n", "ssh-ed25519\n",
        "ssh-ed25519 no-base64!\n", "{\"format\": \"lumen-library\"}\n"})
    EXPECT_THROW(keyOf(text), Error) << text;
  const TemporaryFolder files;
  EXPECT_THROW(readKeyFile(files.path("missing")), Error);
  EXPECT_THROW(readKeyFile(files.path()), Error);
}

TEST(SignatureKey, TellsNoSignerOfWhatIsNoSignature) {
  for (const std::string& text : {std::string(), std::string("hello\n"), kPublic})
    EXPECT_FALSE(minisignSigner(text)) << text;
}

}  // namespace lumen::convert
