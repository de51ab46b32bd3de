#include "crashrank/dispatch/policy.hpp"

#include <array>
#include <cassert>
#include <random>

namespace crashrank {

namespace {

/// The unclaimed core for which `better(core, best so far)` keeps the lowest number on ties.
template <class Better> std::uint32_t best_unclaimed(const Placement& at, Better&& better) {
  assert(at.unclaimed != 0);
  std::uint32_t best = at.cores;
  for (std::uint32_t core = 0; core < at.cores; ++core) {
    if (at.is_unclaimed(core) && (best == at.cores || better(core, best))) best = core;
  }
  return best;
}

class BestMatch final : public PlacementPolicy {
public:
  std::uint32_t choose(const Placement& at) noexcept override {
    return best_unclaimed(at, [&](std::uint32_t core, std::uint32_t best) {
      const std::uint32_t mine = at.similarity(core);
      const std::uint32_t theirs = at.similarity(best);
      return mine != theirs ? mine > theirs : at.batch[core] < at.batch[best];
    });
  }
};

class Random final : public PlacementPolicy {
public:
  void begin(std::uint32_t cores, std::uint64_t seed) override {
    static_cast<void>(cores);
    random_.seed(seed);
  }

  std::uint32_t choose(const Placement& at) noexcept override {
    std::uint32_t count = 0;
    for (std::uint32_t core = 0; core < at.cores; ++core) count += at.is_unclaimed(core) ? 1U : 0U;
    auto skip = static_cast<std::uint32_t>(((random_() >> 32U) * count) >> 32U);
    return best_unclaimed(at, [&](std::uint32_t, std::uint32_t) {
      if (skip == 0) return false;
      --skip;
      return true;
    });
  }

private:
  std::mt19937_64 random_;
};

class Lowest final : public PlacementPolicy {
public:
  std::uint32_t choose(const Placement& at) noexcept override {
    return best_unclaimed(at, [&](std::uint32_t core, std::uint32_t best) {
      const std::uint32_t mine = at.similarity(core);
      const std::uint32_t theirs = at.similarity(best);
      return mine != theirs ? mine < theirs : at.batch[core] < at.batch[best];
    });
  }
};

class BestMatchLoad final : public PlacementPolicy {
public:
  std::uint32_t choose(const Placement& at) noexcept override {
    return best_unclaimed(at, [&](std::uint32_t core, std::uint32_t best) {
      if (at.batch[core] != at.batch[best]) return at.batch[core] < at.batch[best];
      return at.similarity(core) > at.similarity(best);
    });
  }
};

struct Entry {
  Policy policy;
  const char* name;
};

constexpr std::array<Entry, 4> entries{{{Policy::best_match, "best-match"},
                                        {Policy::random, "random"},
                                        {Policy::lowest, "lowest"},
                                        {Policy::best_match_load, "best-match-load"}}};
constexpr std::array<Policy, 4> policies{entries[0].policy, entries[1].policy, entries[2].policy,
                                         entries[3].policy};

}  // namespace

View<const Policy> all_policies() noexcept { return {policies.data(), policies.size()}; }

const char* policy_name(Policy policy) noexcept {
  for (const Entry& entry : entries) {
    if (entry.policy == policy) return entry.name;
  }
  return "?";
}

Result<Policy> policy_from_name(const std::string& name) {
  std::string known;
  for (const Entry& entry : entries) {
    if (name == entry.name) return entry.policy;
    known += known.empty() ? entry.name : std::string(", ") + entry.name;
  }
  return make_error(ErrorCode::usage, "no policy is called '" + name + "'",
                    "choose among " + known);
}

std::unique_ptr<PlacementPolicy> make_policy(Policy policy) {
  switch (policy) {
    case Policy::best_match:
      return std::make_unique<BestMatch>();
    case Policy::random:
      return std::make_unique<Random>();
    case Policy::lowest:
      return std::make_unique<Lowest>();
    case Policy::best_match_load:
      return std::make_unique<BestMatchLoad>();
  }
  return std::make_unique<BestMatch>();
}

}  // namespace crashrank
