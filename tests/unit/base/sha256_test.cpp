// SPDX-License-Identifier: Apache-2.0
#include "converters/base/sha256.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace lumen {
namespace {

// FIPS 180-4's examples, and NIST's long one.
TEST(Sha256, GivesTheDigestsOfTheStandard) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

std::string counted(std::size_t size) {
  std::string text;
  for (std::size_t i = 0; i < size; ++i) text += static_cast<char>(i * 37 + i / 64);
  return text;
}

TEST(Sha256, DoesNotDependOnThePieces) {
  const std::string text = counted(200);
  const std::string whole = sha256(text);
  for (std::size_t first = 0; first <= text.size(); ++first)
    for (const std::size_t second : {0U, 1U, 55U, 63U, 64U, 65U}) {
      Sha256 hash;
      const std::string_view rest = std::string_view(text).substr(first);
      hash.add(std::string_view(text).substr(0, first));
      hash.add(rest.substr(0, second));
      if (second < rest.size()) hash.add(rest.substr(second));
      ASSERT_EQ(hash.text(), whole) << first << ' ' << second;
    }
}

TEST(Sha256, EveryLengthOfTheLastBlockIsFilledUp) {
  // made by Python's hashlib: the digest of the digests of the first 0 to 129 bytes
  std::string all;
  for (std::size_t size = 0; size < 130; ++size) all += sha256(counted(size));
  EXPECT_EQ(sha256(all), "ddefe9e20bf651110694b57d5424a9258fba6cfa6d5d2e65eb83ce9b51e23491");
}

TEST(Sha256, TheProcessorsInstructionsGiveTheSame) {
  const std::string text = counted(5 * kSha256Block);
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  Sha256Words one = {1, 2, 3, 4, 5, 6, 7, 0xffffffff}, other = one;
  addBlocks(one, bytes, 5);
  addBlocksPlainly(other, bytes, 5);
  EXPECT_EQ(one, other);
}

}  // namespace
}  // namespace lumen
