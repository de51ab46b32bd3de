// The checks have to be able to fail. Each planted fault is a copy of the library's header with one
// change, made when the tests are built; the same checks that the library passes must reject it.

#include "oracle/campaign.hpp"
#include "oracle/under_test.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <ostream>
#include <string>
#include <vector>

namespace oracle {

#define TRIANGLE_FAULT(name) bool name(const Triangle& a, const Triangle& b);
#define BOX_FAULT(name) std::array<BoxCheck, box_check_count> name(const BoxCheckOptions& options);
#include "planted_faults.inc"
#undef TRIANGLE_FAULT
#undef BOX_FAULT

namespace {

using BoxTest = std::array<BoxCheck, box_check_count> (*)(const BoxCheckOptions&);

template <class Test> struct Fault {
  const char* name;
  Test test;
};

template <class Test> std::ostream& operator<<(std::ostream& out, const Fault<Test>& fault) {
  return out << fault.name;
}

constexpr Fault<TriangleTest> triangle_faults[] = {
#define TRIANGLE_FAULT(name) {#name, name},
#define BOX_FAULT(name)
#include "planted_faults.inc"
#undef TRIANGLE_FAULT
#undef BOX_FAULT
};

constexpr Fault<BoxTest> box_faults[] = {
#define TRIANGLE_FAULT(name)
#define BOX_FAULT(name) {#name, name},
#include "planted_faults.inc"
#undef TRIANGLE_FAULT
#undef BOX_FAULT
};

CampaignOptions campaign_options() {
  CampaignOptions options;
  options.pairs = 20'000;
  options.seed = 11;
  options.adversarial = 0.9;
  return options;
}

class TriangleFault : public testing::TestWithParam<Fault<TriangleTest>> {};

TEST_P(TriangleFault, IsCaughtByBothOracles) {
  CampaignOptions options = campaign_options();
  options.print_first = 0;
  std::printf("seed %llu\n", static_cast<unsigned long long>(options.seed));
  const CampaignResult result = run_campaign(GetParam().test, options);
  const Tally all = result.all();
  EXPECT_GT(all.wrong(0), 0U);
  EXPECT_GT(all.wrong(1), 0U);
  EXPECT_EQ(all.oracles_differ, 0U);
  std::printf(
      "%llu missed, %llu invented of %llu\n", static_cast<unsigned long long>(all.missed[0]),
      static_cast<unsigned long long>(all.invented[0]), static_cast<unsigned long long>(all.pairs));
}

INSTANTIATE_TEST_SUITE_P(Planted, TriangleFault, testing::ValuesIn(triangle_faults),
                         [](const auto& item) { return std::string(item.param.name); });

TEST(TriangleTest, WithoutAFaultPassesTheSameCampaign) {
  const CampaignResult result = run_campaign(library_triangle_test, campaign_options());
  EXPECT_TRUE(result.all().clean());
}

class BoxFault : public testing::TestWithParam<Fault<BoxTest>> {};

TEST_P(BoxFault, IsCaught) {
  const BoxCheckOptions options;
  std::printf("seed %llu\n", static_cast<unsigned long long>(options.seed));
  std::uint64_t wrong = 0;
  for (const BoxCheck& check : GetParam().test(options)) {
    wrong += check.wrong;
    if (check.wrong == 0) continue;
    std::printf("%s: %llu of %llu wrong\n", check.what,
                static_cast<unsigned long long>(check.wrong),
                static_cast<unsigned long long>(check.tests));
  }
  EXPECT_GT(wrong, 0U);
}

INSTANTIATE_TEST_SUITE_P(Planted, BoxFault, testing::ValuesIn(box_faults),
                         [](const auto& item) { return std::string(item.param.name); });

TEST(BoxTest, NeverSeparatesAContactAndSeesEverySeparation) {
  const BoxCheckOptions options;
  std::printf("seed %llu\n", static_cast<unsigned long long>(options.seed));
  for (const BoxCheck& check : library_box_test(options)) {
    EXPECT_GT(check.tests, options.tests / 10) << check.what;
    EXPECT_EQ(check.wrong, 0U) << check.what << ", of " << check.tests;
  }
}

}  // namespace
}  // namespace oracle
