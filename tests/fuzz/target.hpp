#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

// One thing that reads strangers' bytes. Each target is linked either with libFuzzer, which looks
// for inputs that reach new code, or with driver.cpp, which makes the same inputs every time.
namespace fuzz {

using Bytes = std::vector<std::uint8_t>;

/// Inputs to begin with.
std::vector<Bytes> seeds();

/// Changes an input in a way that suits what it is.
void mutate(Bytes& bytes, std::mt19937_64& random);

/// Takes one input; ends the process where something is wrong. Returns whether it was accepted.
bool take(const Bytes& bytes);

/// Ends the process, in a way that every fuzzer notices.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: %s\n", what);
  std::abort();
}

inline std::size_t below(std::mt19937_64& random, std::size_t bound) {
  return bound == 0 ? 0 : static_cast<std::size_t>(random() % bound);
}

/// Changes that suit any bytes: bits, bytes, runs put in, taken out and repeated.
inline void mutate_bytes(Bytes& bytes, std::mt19937_64& random) {
  if (bytes.empty()) bytes.push_back(0);
  const std::size_t at = below(random, bytes.size());
  const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  const std::size_t run = below(random, std::min<std::size_t>(bytes.size() - at, 64)) + 1;
  switch (random() % 6) {
    case 0:
      bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 1U << random() % 8);
      break;
    case 1:
      bytes[at] = static_cast<std::uint8_t>(random());
      break;
    case 2:
      bytes.erase(place, place + static_cast<std::ptrdiff_t>(std::min(run, bytes.size() - at)));
      break;
    case 3:
      bytes.insert(place, run, static_cast<std::uint8_t>(random()));
      break;
    case 4: {
      const Bytes copied(place,
                         place + static_cast<std::ptrdiff_t>(std::min(run, bytes.size() - at)));
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(below(random, bytes.size())),
                   copied.begin(), copied.end());
      break;
    }
    default:
      bytes.resize(at);
      break;
  }
}

}  // namespace fuzz
