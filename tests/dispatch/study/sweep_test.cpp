#include "crashrank/dispatch/study/study.hpp"

#include "crashrank/model/make_model.hpp"

#include "dispatch/sample_bodies.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace crashrank {
namespace {

struct SweptBodies {
  Model a = std::move(make_model(test::hull(30, 40, 1)).value());
  Model b = std::move(make_model(test::hull(30, 40, 2)).value());
  std::vector<Pose> poses = test::crash_poses(2, 0.7, 5);
};

TEST(Sweep, HasARowForEveryPolicyAtEveryDepth) {
  const SweptBodies scene;
  SweepOptions options;
  options.depths = {3, 7};
  options.repeat = 2;
  std::size_t told = 0;
  options.progress = [&](std::size_t done, std::size_t total) {
    EXPECT_EQ(done, ++told);
    EXPECT_EQ(total, 2U);
  };
  for (const bool batch : {false, true}) {
    for (const Kernel kernel : {Kernel::scalar, Kernel::fast}) {
      told = 0;
      options.batch = batch;
      options.kernel = kernel;
      options.store = kernel == Kernel::fast ? StoreMode::shared : StoreMode::private_copy;
      const Result<Sweep> swept = sweep(scene.a, scene.b, scene.poses, options);
      ASSERT_TRUE(swept.ok()) << swept.error().message();
      EXPECT_EQ(told, 2U);
      const std::vector<SweepRow>& rows = swept.value().rows;
      ASSERT_EQ(rows.size(), 2 * all_policies().size());
      for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i].depth, i < all_policies().size() ? 3U : 7U);
        EXPECT_EQ(rows[i].policy, all_policies()[i % all_policies().size()]);
        EXPECT_EQ(rows[i].end, DispatchEnd::ok);
        EXPECT_GT(rows[i].jobs, 1.0);
        EXPECT_GT(rows[i].seconds, 0.0);
        EXPECT_GT(rows[i].serial_seconds, 0.0);
        EXPECT_GT(rows[i].speedup, 0.0);
        EXPECT_GT(rows[i].replayed_speedup, 0.0);
        EXPECT_GT(rows[i].relative_transfer, 0.0);
        EXPECT_GT(rows[i].peak_part_bytes, 0.0);
        EXPECT_LE(rows[i].peak_part_bytes, rows[i].transferred_bytes);
      }
    }
  }
}

TEST(Sweep, TrimsWhatDoesNotFit) {
  const SweptBodies scene;
  SweepOptions options;
  options.depths = {1, 9};
  options.policies = {Policy::lowest};
  options.repeat = 1;
  options.store_bytes = 40'000;
  const Result<Sweep> swept = sweep(scene.a, scene.b, scene.poses, options);
  ASSERT_TRUE(swept.ok());
  ASSERT_EQ(swept.value().rows.size(), 2U);
  EXPECT_EQ(swept.value().rows[0].end, DispatchEnd::out_of_memory);
  EXPECT_EQ(swept.value().rows[1].end, DispatchEnd::ok);
}

TEST(Sweep, RefusesWhatHasNoMeaning) {
  const SweptBodies scene;
  SweepOptions options;
  options.depths = {17};
  EXPECT_FALSE(sweep(scene.a, scene.b, scene.poses, options).ok());
  options = {};
  options.workers = 0;
  EXPECT_FALSE(sweep(scene.a, scene.b, scene.poses, options).ok());
  EXPECT_FALSE(sweep(scene.a, scene.b, {}, {}).ok());
  options = {};
  options.kernel = Kernel::fast;
  EXPECT_EQ(sweep(scene.a, scene.b, scene.poses, options).error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace crashrank
