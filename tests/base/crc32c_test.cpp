#include "base/crc32c.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace crashrank::detail {
namespace {

// RFC 3720, section B.4, and the customary check value.
TEST(Crc32c, GivesThePublishedValues) {
  std::string counting(32, '\0');
  for (std::size_t i = 0; i < 32; ++i) counting[i] = static_cast<char>(i);
  const std::string falling(counting.rbegin(), counting.rend());
  const std::vector<std::pair<std::string, std::uint32_t>> published{
      {std::string(32, '\0'), 0x8a9136aa},
      {std::string(32, '\xff'), 0x62a8ab43},
      {counting, 0x46dd794e},
      {falling, 0x113fdb5c},
      {"123456789", 0xe3069283},
      {"", 0}};
  for (const auto& [text, value] : published) {
    EXPECT_EQ(crc32c(text.data(), text.size()), value);
    EXPECT_EQ(crc32c_by_tables(text.data(), text.size()), value);
  }
}

TEST(Crc32c, IsTheSameWithAndWithoutTheInstructionAndInPieces) {
  std::mt19937_64 random(5);
  std::vector<unsigned char> bytes(70'000);
  for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(random());
  for (int round = 0; round < 200; ++round) {
    const std::size_t first = random() % 100;
    const std::size_t size = random() % (round < 100 ? 200 : bytes.size() - 100);
    const std::uint32_t whole = crc32c(&bytes[first], size);
    ASSERT_EQ(whole, crc32c_by_tables(&bytes[first], size)) << first << " " << size;
    const std::size_t cut = size == 0 ? 0 : random() % size;
    ASSERT_EQ(whole, crc32c(&bytes[first + cut], size - cut, crc32c(&bytes[first], cut)));
  }
}

}  // namespace
}  // namespace crashrank::detail
