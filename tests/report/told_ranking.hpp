#pragma once

#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {

/// One triangle, its part named as asked.
inline Model flat_body(const std::string& part) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.parts = {{part, 0, 1}};
  Result<Model> model = make_model(std::move(mesh));
  EXPECT_TRUE(model.ok());
  return std::move(*model);
}

/// Three candidates as a deadline may leave them: one misses, one hits two bodies, one is known by
/// its interval alone.
struct Told {
  Told() {
    models.push_back(flat_body("hood"));
    models.push_back(flat_body("\x1b[31mdoor"));
    scenario.name = "told \"<b>\x1b[2J";
    scenario.models.resize(2);
    scenario.models[0].name = "car";
    scenario.models[1].name = "wall";
    scenario.models[1].kind = BodyKind::building;
    scenario.ego.model = 0;
    for (const char* name : {"wall", "second"}) {
      ScenarioActor actor;
      actor.name = name;
      actor.model = 1;
      scenario.actors.push_back(actor);
    }
    for (const char* name : {"miss", "hit", "unknown"}) {
      Candidate candidate;
      candidate.name = name;
      result.candidates.push_back(candidate);
    }
    CandidateResult miss;
    miss.candidate = 0;
    miss.score = 0.0;
    miss.grazes.push_back({1, 0.25});
    CandidateResult hit;
    hit.candidate = 1;
    hit.score = 3.0;
    hit.score_interval = {3.0, 3.0};
    hit.collides = true;
    for (const std::size_t actor : {0U, 1U}) {
      Contact contact;
      contact.actor = actor;
      contact.time_of_impact_s = 0.5 + static_cast<double>(actor);
      contact.closing_speed_mps = 10.0;
      contact.ego.triangles = {0};
      contact.ego.parts = {0};
      contact.other = contact.ego;
      contact.other.area_m2 = 0.5;
      hit.contacts.push_back(contact);
    }
    hit.ego = hit.contacts.front().ego;
    CandidateResult unknown;
    unknown.candidate = 2;
    unknown.score_interval = {1.0, 8.0};
    unknown.score_estimate = 2.5;
    unknown.collides = true;
    result.ranking = {miss, hit, unknown};
    for (std::size_t i = 0; i < result.ranking.size(); ++i) result.ranking[i].place = i + 1;
    result.complete = false;
    result.in_race = {0, 2};
    result.ego = {0, 1500.0, false};
    const double fixed = std::numeric_limits<double>::infinity();
    result.actors = {{1, fixed, true}, {1, fixed, true}};
  }

  /// Lets what the second candidate hits first be pushed into a third body, named as asked, at
  /// 0.75 s, between the ego's contacts; the triangles are those that the ego damages as well.
  void push_into(const std::string& name) {
    ScenarioActor actor;
    actor.name = name;
    actor.model = 1;
    scenario.actors.push_back(actor);
    result.actors.push_back(result.actors.front());
    FurtherContact contact;
    contact.a = 0;
    contact.b = 2;
    contact.time_s = 0.75;
    contact.closing = {4.0, 3.0, 0.0};
    contact.closing_speed_mps = 5.0;
    contact.harm = 0.31;
    contact.outcome_a.delta_v_mps = 1.5;
    contact.outcome_a.exposure_mps = 6.25;
    contact.outcome_b.delta_v_mps = 3.5;
    contact.outcome_b.harm = 0.31;
    contact.damage_a = result.ranking[1].contacts[0].other;
    contact.damage_b = contact.damage_a;
    result.ranking[1].further = {contact};
  }

  Scenario scenario;
  std::vector<Model> models;
  RankResult result;
};

}  // namespace crashrank
