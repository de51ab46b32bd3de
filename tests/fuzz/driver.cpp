// Runs a target on inputs that are the same every time: its seeds, then mutations of them. Says how
// many it took and how many were accepted.
//
//   TARGET [ROUNDS [SEED]]      or      TARGET FILE...    takes each file once

#include "fuzz/target.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

int main(int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "20000";
  if (first.find_first_not_of("0123456789") != std::string::npos) {
    for (int i = 1; i < argc; ++i) {
      std::ifstream in(argv[i], std::ios::binary);
      const fuzz::Bytes bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
      std::printf("%s: %s\n", argv[i], fuzz::take(bytes) ? "accepted" : "refused");
    }
    return 0;
  }
  const unsigned long rounds = std::strtoul(first.c_str(), nullptr, 10);
  const unsigned long seed = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1;
  std::mt19937_64 random(seed);
  const std::vector<fuzz::Bytes> seeds = fuzz::seeds();
  fuzz::require(!seeds.empty(), "there are no seeds");
  for (const fuzz::Bytes& whole : seeds) fuzz::require(fuzz::take(whole), "a seed is refused");
  unsigned long accepted = 0;
  for (unsigned long i = 0; i < rounds; ++i) {
    fuzz::Bytes bytes = seeds[fuzz::below(random, seeds.size())];
    const std::size_t changes = 1 + fuzz::below(random, 3);
    for (std::size_t change = 0; change < changes; ++change) fuzz::mutate(bytes, random);
    if (fuzz::take(bytes)) ++accepted;
  }
  std::printf("seed %lu: %lu mutations of %zu inputs, %lu accepted\n", seed, rounds, seeds.size(),
              accepted);
  return 0;
}
