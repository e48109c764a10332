// SPDX-License-Identifier: Apache-2.0
// The signer of a signature, with keys that the programs make for the test.
#include "converters/library/publish/signature.h"

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "tests/unit/library/made_library.h"
#include "tests/unit/library/temporary_folder.h"

namespace lumen::convert {
namespace {

const std::string kPublisherName = "publisher@example.org", kOther = "other@example.org";

/// A library signed by OpenSSH, and a list of two allowed signers of whom one signed it.
class SignedByOpenSsh : public testing::Test {
protected:
  void SetUp() override {
    if (!makeKey("mine") || !makeKey("theirs")) GTEST_SKIP() << "no ssh-keygen (openssh-client)";
    m_files.write("allowed", kPublisherName + " " + m_files.read("mine.pub") + kOther + " " +
                                 m_files.read("theirs.pub"));
    m_signature = sign(m_text, m_library, key("mine"), m_progress).bytes;
  }

  [[nodiscard]] bool makeKey(const std::string& name) const {
    const std::string command = "ssh-keygen -q -t ed25519 -N '' -C test -f '" +
                                m_files.path(name).string() + "' >/dev/null 2>&1";
    return std::system(command.c_str()) == 0;
  }
  [[nodiscard]] KeyFile key(const std::string& name) const {
    return readKeyFile(m_files.path(name));
  }
  [[nodiscard]] TrustAnswer verified(const std::string& trusted,
                                     const std::string& identity = "") const {
    return verifySignature(m_text, m_signature, key(trusted), identity, m_progress);
  }

  TemporaryFolder m_files;
  LibraryFile m_library = madeLibrary();
  std::string m_text = libraryText(m_library), m_signature;
  Progress m_progress;
};

TEST_F(SignedByOpenSsh, IsTrustedByThePublicKeyOfItsSigner) {
  EXPECT_EQ(verified("mine.pub").trust, Trust::Trusted);
}

TEST_F(SignedByOpenSsh, IsNotTrustedByAnotherPublicKey) {
  EXPECT_EQ(verified("theirs.pub").trust, Trust::Untrusted);
}

TEST_F(SignedByOpenSsh, IsTrustedByAListThatHasTheSigner) {
  const TrustAnswer answer = verified("allowed");
  EXPECT_EQ(answer.trust, Trust::Trusted);
  EXPECT_EQ(answer.signer.identity, kPublisherName);
}

TEST_F(SignedByOpenSsh, IsTrustedUnderTheNameThatItsSignerHasInTheList) {
  EXPECT_EQ(verified("allowed", kPublisherName).trust, Trust::Trusted);
}

TEST_F(SignedByOpenSsh, IsNotTrustedUnderTheNameOfAnotherSignerOfTheList) {
  EXPECT_EQ(verified("allowed", kOther).trust, Trust::Untrusted);
}

TEST_F(SignedByOpenSsh, IsNotTrustedUnderANameThatTheListLacks) {
  EXPECT_EQ(verified("allowed", "nobody@example.org").trust, Trust::Untrusted);
}

TEST_F(SignedByOpenSsh, IsBrokenForAnotherTextUnderEveryName) {
  m_text.back() = ' ';
  for (const std::string& identity : {std::string(), kPublisherName, kOther})
    EXPECT_EQ(verified("allowed", identity).trust, Trust::Broken) << identity;
}

TEST_F(SignedByOpenSsh, NoSignatureIsUnsignedUnderEveryName) {
  for (const std::string& identity : {std::string(), kPublisherName})
    EXPECT_EQ(verifySignature(m_text, {}, key("allowed"), identity, m_progress).trust,
              Trust::Unsigned);
}

TEST_F(SignedByOpenSsh, ASecretKeyDoesNotVerify) {
  EXPECT_THROW((void)verified("mine"), Error);
}

}  // namespace
}  // namespace lumen::convert
