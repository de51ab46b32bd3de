#include "crashrank/internal/base/sha256.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace crashrank {
namespace {

std::string hex(const std::array<std::uint8_t, 32>& digest) {
  static const char* digits = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : digest) {
    text += digits[byte >> 4U];
    text += digits[byte & 15U];
  }
  return text;
}

std::string sha256(const std::string& message, std::size_t piece) {
  Sha256 hash;
  for (std::size_t i = 0; i < message.size(); i += piece) {
    hash.update(message.data() + i, std::min(piece, message.size() - i));
  }
  return hex(hash.digest());
}

// Vectors of FIPS 180-4 / NIST CAVP.
TEST(Sha256, PublishedVectors) {
  EXPECT_EQ(sha256("", 1), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc", 3), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", 7),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1'000'000, 'a'), 1000),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PiecesDoNotMatter) {
  const std::string message(257, 'x');
  for (std::size_t piece = 1; piece <= message.size(); ++piece) {
    EXPECT_EQ(sha256(message, piece), sha256(message, message.size()));
  }
}

}  // namespace
}  // namespace crashrank
