// Gives a target to libFuzzer: coverage chooses which inputs are mutated further, by the target's
// own mutations and by libFuzzer's.

#include "fuzz/target.hpp"

#include <algorithm>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::take(fuzz::Bytes(data, data + size));
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  std::mt19937_64 random(seed);
  if (size > 1 && random() % 3 == 0) return LLVMFuzzerMutate(data, size, max_size);
  static const std::vector<fuzz::Bytes> seeds = fuzz::seeds();
  fuzz::Bytes bytes(data, data + size);
  if (size <= 1 || random() % 64 == 0) bytes = seeds[fuzz::below(random, seeds.size())];
  fuzz::mutate(bytes, random);
  bytes.resize(std::min(bytes.size(), max_size));
  std::copy(bytes.begin(), bytes.end(), data);
  return bytes.size();
}
