#include "arrays.hpp"
#include "error.hpp"
#include "interrupts.hpp"
#include "model.hpp"

#include "crashrank/collide/body_state.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/dispatch/worker_pool.hpp"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

namespace crashrank::python {
namespace {

using Clock = std::chrono::steady_clock;
using PairArray = nb::ndarray<nb::numpy, std::int32_t, nb::shape<-1, 2>>;
using OffsetArray = nb::ndarray<nb::numpy, std::int64_t, nb::shape<-1>>;
using TouchArray = nb::ndarray<nb::numpy, bool, nb::shape<-1>>;

std::vector<Pose> read_poses(const GivenPoses& given) {
  std::vector<Pose> poses;
  poses.reserve(given.shape(0));
  for (std::size_t i = 0; i < given.shape(0); ++i) {
    Result<Pose> pose = pose_from_matrix({given.data() + 16 * i, 16});
    if (!pose) {
      pose.error().place = "poses[" + std::to_string(i) + "]";
      throw Failure(pose.error());
    }
    poses.push_back(*pose);
  }
  return poses;
}

Pose read_pose(const Given<double, nb::shape<4, 4>>& given) {
  Result<Pose> pose = pose_from_matrix({given.data(), 16});
  if (!pose) pose.error().place = "pose";
  return value_of(std::move(pose));
}

/// What each thread that asks keeps between its calls.
struct Scratch {
  ModelWorkspace workspace;
  std::vector<Pair> pairs;
};

Scratch& scratch_for(const Body& a, const Body& b) {
  thread_local Scratch scratch;
  scratch.workspace.prepare(a.model(), b.model());
  return scratch;
}

/// Tests of boxes and triangles, in eights, between two readings of the clock: a small part of
/// `look_every`, and so many that a reading costs nothing beside them.
constexpr std::uint64_t tests_between_looks = 10'000;

/// Queries at a run of poses on the calling thread, which does not hold the interpreter's lock;
/// `query(index, scratch)` returns its result. Looks at the signals now and then where `interrupts`
/// is not null.
template <class Query>
void run_queries(const Body& a, const Body& b, std::size_t begin, std::size_t end,
                 Interrupts* interrupts, const Query& query) {
  Scratch& scratch = scratch_for(a, b);
  std::uint64_t tests = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const CollideResult result = query(i, scratch);
    tests += result.work.bv_tests + result.work.primitive_tests;
    if (interrupts != nullptr && tests >= tests_between_looks) {
      tests = 0;
      interrupts->look();
    }
  }
}

/// Queries at all poses, on `workers` threads, the calling one alone for one. The interpreter's
/// lock is not held.
template <class Query>
void run_all_queries(const Body& a, const Body& b, std::size_t count, std::uint32_t workers,
                     const Query& query) {
  Interrupts interrupts;
  if (workers <= 1) return run_queries(a, b, 0, count, &interrupts, query);
  PoolOptions options;
  options.workers = workers;
  WorkerPool pool = value_of(WorkerPool::start(options));
  // Rounds grow until one takes a while: few enough that starting them costs nothing, short enough
  // that signals are seen.
  const std::size_t most_runs = std::size_t{8} * workers;
  std::size_t round = most_runs;
  for (std::size_t begin = 0; begin < count;) {
    const std::size_t size = std::min(round, count - begin);
    const std::size_t runs = std::min(most_runs, size);
    const auto start = Clock::now();
    check(pool.for_each(runs, [&](std::size_t run, std::uint32_t) {
      run_queries(a, b, begin + size * run / runs, begin + size * (run + 1) / runs, nullptr, query);
    }));
    if (Clock::now() - start < look_every / 4) round *= 2;
    begin += size;
    interrupts.look();
  }
}

PairArray collide_once(const Body& a, const Body& b, const Given<double, nb::shape<4, 4>>& given) {
  const Pose pose = read_pose(given);
  std::vector<Pair> pairs;
  std::vector<std::int32_t> flat;
  {
    const nb::gil_scoped_release unlocked;
    collide(a.model(), b.model(), pose, pairs, scratch_for(a, b).workspace);
    std::sort(pairs.begin(), pairs.end());
    flat.reserve(2 * pairs.size());
    for (const Pair& pair : pairs) {
      flat.push_back(pair.a);
      flat.push_back(pair.b);
    }
  }
  return make_array<std::int32_t, nb::shape<-1, 2>>(std::move(flat), {pairs.size(), 2});
}

TouchArray collide_any(const Body& a, const Body& b, const GivenPoses& given,
                       std::uint32_t workers) {
  const std::vector<Pose> poses = read_poses(given);
  auto touch = std::make_unique<bool[]>(poses.size());
  {
    const nb::gil_scoped_release unlocked;
    CollideOptions options;
    options.any = true;
    run_all_queries(a, b, poses.size(), workers, [&](std::size_t i, Scratch& scratch) {
      const CollideResult result =
          collide(a.model(), b.model(), poses[i], scratch.pairs, scratch.workspace, options);
      touch[i] = result.intersecting;
      return result;
    });
  }
  bool* const data = touch.get();
  const nb::capsule keeper(data, [](void* kept) noexcept { delete[] static_cast<bool*>(kept); });
  touch.release();
  return TouchArray(data, {poses.size()}, keeper);
}

/// The name of the state at each pose.
std::vector<std::string> collide_state(const Body& a, const Body& b, const GivenPoses& given,
                                       std::uint32_t workers) {
  const std::vector<Pose> poses = read_poses(given);
  std::vector<BodyState> states(poses.size());
  {
    const nb::gil_scoped_release unlocked;
    const Solid solid_a = make_solid(a.model().mesh);
    const Solid solid_b = make_solid(b.model().mesh);
    CollideOptions options;
    options.any = true;
    run_all_queries(a, b, poses.size(), workers, [&](std::size_t i, Scratch& scratch) {
      const CollideResult result =
          collide(a.model(), b.model(), poses[i], scratch.pairs, scratch.workspace, options);
      states[i] = body_state(a.model(), solid_a, b.model(), solid_b, poses[i], result);
      return result;
    });
  }
  std::vector<std::string> names;
  names.reserve(states.size());
  for (const BodyState state : states) names.emplace_back(body_state_name(state));
  return names;
}

/// Pairs of all poses one after the other, each pose's sorted, and where each begins.
std::pair<PairArray, OffsetArray> collide_all(const Body& a, const Body& b, const GivenPoses& given,
                                              std::uint32_t workers) {
  const std::vector<Pose> poses = read_poses(given);
  std::vector<std::int32_t> flat;
  std::vector<std::int64_t> offsets(poses.size() + 1, 0);
  {
    const nb::gil_scoped_release unlocked;
    std::vector<std::vector<Pair>> found(poses.size());
    run_all_queries(a, b, poses.size(), workers, [&](std::size_t i, Scratch& scratch) {
      const CollideResult result =
          collide(a.model(), b.model(), poses[i], scratch.pairs, scratch.workspace);
      std::sort(scratch.pairs.begin(), scratch.pairs.end());
      found[i] = scratch.pairs;
      return result;
    });
    for (std::size_t i = 0; i < found.size(); ++i) {
      offsets[i + 1] = offsets[i] + static_cast<std::int64_t>(found[i].size());
    }
    flat.reserve(2 * static_cast<std::size_t>(offsets.back()));
    for (std::vector<Pair>& of_pose : found) {
      for (const Pair& pair : of_pose) {
        flat.push_back(pair.a);
        flat.push_back(pair.b);
      }
      of_pose = {};
    }
  }
  const std::size_t pairs = flat.size() / 2;
  const std::size_t ends = offsets.size();
  return {make_array<std::int32_t, nb::shape<-1, 2>>(std::move(flat), {pairs, 2}),
          make_array<std::int64_t, nb::shape<-1>>(std::move(offsets), {ends})};
}

std::string hash_of(const Given<std::int32_t, nb::shape<-1, 2>>& given) {
  std::vector<Pair> pairs(given.shape(0));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i] = {given.data()[2 * i], given.data()[2 * i + 1]};
  }
  const nb::gil_scoped_release unlocked;
  std::sort(pairs.begin(), pairs.end());
  return pairs_hash(pairs);
}

nb::ndarray<nb::numpy, double, nb::shape<4, 4>> matrix_of(double x_m, double y_m, double z_m,
                                                          double yaw_rad, double pitch_rad,
                                                          double roll_rad) {
  const Pose pose = pose_from_angles({x_m, y_m, z_m}, yaw_rad, pitch_rad, roll_rad);
  std::vector<double> rows(16, 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < 3; ++j) {
      rows[4 * i + j] = pose.rotation(row, static_cast<Eigen::Index>(j));
    }
    rows[4 * i + 3] = pose.translation[row];
  }
  rows[15] = 1.0;
  return make_array<double, nb::shape<4, 4>>(std::move(rows), {4, 4});
}

}  // namespace

void bind_queries(nb::module_& module) {
  module.def("collide", &collide_once, nb::arg("a"), nb::arg("b"), nb::arg("pose").noconvert(),
             "Pairs at one pose, sorted.");
  module.def("collide_any", &collide_any, nb::arg("a"), nb::arg("b"), nb::arg("poses").noconvert(),
             nb::arg("workers"), "By pose, whether any two triangles share a point.");
  module.def("collide_state", &collide_state, nb::arg("a"), nb::arg("b"),
             nb::arg("poses").noconvert(), nb::arg("workers"), "By pose, the name of the state.");
  module.def("collide_all", &collide_all, nb::arg("a"), nb::arg("b"), nb::arg("poses").noconvert(),
             nb::arg("workers"), "Pairs of all poses, and by pose where they begin.");
  module.def("pairs_hash", &hash_of, nb::arg("pairs").noconvert(),
             "Fingerprint of pairs, sorted here.");
  module.def("pose_matrix", &matrix_of, nb::arg("x_m"), nb::arg("y_m"), nb::arg("z_m"),
             nb::arg("yaw_rad"), nb::arg("pitch_rad"), nb::arg("roll_rad"),
             "Row-major 4x4 matrix of a pose.");
  module.def("vector_unit", &vector_unit, "Name of the vector unit in use.");
  module.attr("max_workers") = max_workers;
}

}  // namespace crashrank::python
