#include "bench/rank/situations.hpp"
#include "crashrank/model/make_model.hpp"

#include "bench/workload.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <random>
#include <utility>

namespace bench {
namespace {

using namespace crashrank;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// In [-1, 1), the same with every library.
double even(std::mt19937_64& engine) {
  return static_cast<double>(engine() >> 11U) * 0x1p-52 - 1.0;
}

}  // namespace

Result<Situations> make_situations(const std::string& file, std::size_t triangles,
                                   std::size_t variants, std::uint64_t seed) {
  Result<Scenario> scenario = load_scenario_file(file);
  if (!scenario) return scenario.error();
  Situations s;
  s.scenario = std::move(*scenario);
  s.name = std::filesystem::path(file).stem().string();
  for (const ScenarioModel& wanted : s.scenario.models) {
    auto start = Clock::now();
    TriangleMesh mesh;
    if (triangles == 0) {
      Result<TriangleMesh> read = imported_mesh(wanted.path);
      if (!read) return read.error();
      mesh = std::move(*read);
    } else {
      mesh = shipped_model(std::filesystem::path(wanted.path).stem().string(), triangles);
    }
    s.load_s += seconds_since(start);
    s.triangles = std::max(s.triangles, mesh.size());
    start = Clock::now();
    Result<Model> model = make_model(std::move(mesh));
    if (!model) return model.error();
    s.build_s += seconds_since(start);
    s.models.push_back(std::move(*model));
  }
  Result<std::vector<Candidate>> candidates = make_candidates(
      s.scenario, static_cast<double>(s.models[s.scenario.ego.model].mesh.bounds().extent().x()));
  if (!candidates) return candidates.error();
  s.candidates = std::move(*candidates);

  std::mt19937_64 engine(seed);
  for (std::size_t variant = 0; variant < variants; ++variant) {
    Scenario moved = s.scenario;
    for (ScenarioActor& actor : moved.actors) {
      if (variant == 0) continue;
      const double aside_x = 2.0 * even(engine);
      const double aside_y = 0.5 * even(engine);
      const double faster = 1.0 + 0.2 * even(engine);
      const auto move = [=](ActorMotion& motion) {
        if (!motion.poses.empty()) return;
        motion.pose.translation += Eigen::Vector3d(aside_x, aside_y, 0.0);
        motion.speed_mps *= faster;
      };
      move(actor);
      for (Prediction& prediction : actor.predictions) move(prediction);
    }
    Result<std::vector<Motion>> motions = plan_motions(moved);
    if (!motions) return motions.error();
    s.motions.push_back(std::move(*motions));
  }
  return s;
}

Result<Ranker> prepare_ranker(const Situations& situations, const std::string& measure,
                              unsigned workers) {
  const Result<Measure> known = measure_from_name(measure);
  if (!known) return known.error();
  RankerOptions how;
  how.rank.measure = *known;
  how.rank.workers = workers;
  how.limits.candidates = situations.candidates.size();
  return Ranker::prepare(situations.scenario, situations.models, how);
}

}  // namespace bench
