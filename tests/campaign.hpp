#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace crashrank::test {

/// A count or seed for a campaign, from an environment variable; `otherwise` where it is not set.
inline std::uint64_t wished(const char* variable, std::uint64_t otherwise) {
  const char* const wish = std::getenv(variable);
  return wish != nullptr ? std::strtoull(wish, nullptr, 10) : otherwise;
}

/// Random scenes of a property test.
struct Campaign {
  std::uint64_t seed = 0;
  std::uint64_t count = 0;
};

/// As CRASHRANK_SCENE_SEED and CRASHRANK_SCENE_COUNT say, or as given; prints the seed.
inline Campaign scene_campaign(std::uint64_t seed, std::uint64_t count) {
  const Campaign wish{wished("CRASHRANK_SCENE_SEED", seed), wished("CRASHRANK_SCENE_COUNT", count)};
  std::printf("seed %llu\n", static_cast<unsigned long long>(wish.seed));
  return wish;
}

}  // namespace crashrank::test
