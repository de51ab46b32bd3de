// A ranking that paper can check: towards a wall 7 m ahead at 10 m/s, 1500 kg. Braking by 8 m/s²
// ends after 6.25 m; by 5 m/s² it meets the wall with v² = 100 − 2·5·7 = 30 m²/s².
#include <crashrank/crashrank.hpp>
#include <crashrank/model/make_model.hpp>

#include <cstdio>
#include <vector>

namespace {

crashrank::TriangleMesh box(float x0, float x1, float y, float z) {
  crashrank::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) != 0 ? x1 : x0, (i & 2) != 0 ? y : -y, (i & 4) != 0 ? z : 0);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  mesh.parts = {{"box", 0, 12}};
  return mesh;
}

}  // namespace

int main() {
  using namespace crashrank;
  Scenario scenario;
  scenario.name = "wall";
  scenario.measure = Measure::closing_energy;
  scenario.grid.reset();
  scenario.add_straight_braking = false;
  scenario.models.resize(2);
  scenario.models[0].name = "car";
  scenario.models[0].mass_kg = 1500;
  scenario.models[1].name = "wall";
  scenario.models[1].kind = BodyKind::building;
  scenario.ego.speed_mps = 10;
  ScenarioActor wall;
  wall.name = "wall";
  wall.model = 1;
  wall.pose.translation.x() = 11;
  scenario.actors.push_back(wall);
  for (const double braking : {0.0, 5.0, 8.0}) {
    ListedCandidate candidate;
    candidate.name = "brake " + std::to_string(static_cast<int>(braking));
    candidate.acceleration_mps2 = -braking;
    candidate.steering_rad = 0.0;
    scenario.listed.push_back(candidate);
  }
  std::vector<Model> models;
  for (TriangleMesh mesh : {box(-1, 4, 0.9F, 1.5F), box(0, 1, 5, 3)}) {
    Result<Model> model = make_model(std::move(mesh));
    if (!model) return 1;
    models.push_back(std::move(*model));
  }
  const Result<RankResult> ranked = rank(scenario, models);
  if (!ranked) {
    std::puts(ranked.error().message().c_str());
    return 1;
  }
  for (const CandidateResult& result : ranked->ranking) {
    std::printf("%s: %.1f kJ\n", ranked->candidates[result.candidate].name.c_str(),
                result.score.value_or(-1e3) / 1e3);
  }
}
