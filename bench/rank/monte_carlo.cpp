// Scores over a stratified sample of futures beside plain Monte Carlo: worlds drawn one by one,
// each written out without uncertainty and ranked by itself. Worlds of predictions, absences and
// joint futures repeat: the scores of those that were drawn before are reused.
#include "bench/rank/situations.hpp"

#include "crashrank/rank/anytime/ranker.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace crashrank;

struct Options {
  std::vector<std::string> scenarios;
  std::size_t worlds = 2000;
  double seconds = std::numeric_limits<double>::infinity();  ///< for each scenario
  std::size_t sampled = 64;
  std::size_t listed = 0;
  std::uint64_t seed = 1;
  unsigned workers = 2;
  bool check = false;  ///< rank repeated worlds again and compare
};

/// Mean and standard error of numbers that come one by one (Welford 1962).
class Mean {
public:
  void add(double number) {
    count_ += 1.0;
    const double away = number - mean_;
    mean_ += away / count_;
    squares_ += away * (number - mean_);
  }
  double mean() const { return mean_; }
  double error() const {
    return count_ < 2.0 ? 0.0 : std::sqrt(squares_ / (count_ - 1.0) / count_);
  }

private:
  double count_ = 0.0;
  double mean_ = 0.0;
  double squares_ = 0.0;
};

/// What happens in one world, errors of states aside: the joint future, or the prediction of each
/// actor. Worlds with equal choices and without errors are the same world.
using Choices = std::vector<std::uint32_t>;

/// Draws worlds as the scenario states their probabilities.
class Worlds {
public:
  Worlds(const Scenario& scenario, std::uint64_t seed) : scenario_(scenario), random_(seed) {
    std::vector<double> weights;
    for (const JointFuture& future : scenario.futures) weights.push_back(future.probability);
    joint_ = Distribution(weights.begin(), weights.end());
    for (const ScenarioActor& actor : scenario.actors) {
      weights.clear();
      for (const Prediction& each : actor.predictions) weights.push_back(each.probability);
      predictions_.emplace_back(weights.begin(), weights.end());
    }
  }

  /// Errors of states are continuous: no two worlds that have them are the same.
  bool repeat() const {
    return !scenario_.ego.uncertainty.any() &&
           std::none_of(scenario_.actors.begin(), scenario_.actors.end(),
                        [](const ScenarioActor& actor) { return actor.perception.any(); });
  }

  StateError draw_error(const StateUncertainty& of) {
    if (!of.any()) return {};
    return {of.position_m * normal_(random_), of.position_m * normal_(random_),
            of.heading_rad * normal_(random_), of.speed_mps * normal_(random_)};
  }

  /// Joint future, then for each actor its prediction or `absent`.
  Choices draw_choices() {
    Choices choices{0};
    if (!scenario_.futures.empty()) choices.front() = joint_(random_);
    for (std::size_t i = 0; i < scenario_.actors.size(); ++i) {
      const ScenarioActor& actor = scenario_.actors[i];
      choices.push_back(actor.predictions.empty() ? 0 : predictions_[i](random_));
      if (even_(random_) >= actor.existence_probability) choices.back() = absent;
    }
    return choices;
  }

  /// Motions of all actors, with newly drawn errors of their states.
  Result<std::vector<Motion>> motions(const Choices& choices) {
    Scenario world = scenario_;
    if (!world.futures.empty()) {
      const JointFuture& future = scenario_.futures[choices.front()];
      for (const FutureMotion& moved : future.motions) {
        static_cast<ActorMotion&>(world.actors[moved.actor]) = moved.motion;
      }
      for (const std::size_t actor : future.absent) remove(world.actors[actor]);
      world.futures.clear();
    }
    for (std::size_t i = 0; i < world.actors.size(); ++i) {
      ScenarioActor& actor = world.actors[i];
      const std::uint32_t choice = choices[i + 1];
      if (!actor.predictions.empty()) {
        static_cast<ActorMotion&>(actor) = actor.predictions[choice == absent ? 0 : choice];
        actor.predictions.clear();
      }
      if (choice == absent) remove(actor);
      actor.existence_probability = 1.0;
    }
    Result<std::vector<Motion>> motions = plan_motions(world);
    for (std::size_t i = 0; motions && i < motions->size(); ++i) {
      if (scenario_.actors[i].perception.any()) {
        (*motions)[i].displace(draw_error(scenario_.actors[i].perception));
      }
    }
    return motions;
  }

private:
  using Distribution = std::discrete_distribution<std::uint32_t>;
  static constexpr std::uint32_t absent = static_cast<std::uint32_t>(-1);
  /// Out of reach within the longest horizon.
  static constexpr double far_away_m = 5e4;

  static void remove(ScenarioActor& actor) {
    actor.poses.clear();
    actor.pose.translation.y() = far_away_m;
    actor.speed_mps = actor.acceleration_mps2 = actor.yaw_rate_radps = 0.0;
  }

  const Scenario& scenario_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> even_{0.0, 1.0};
  Distribution joint_;
  std::vector<Distribution> predictions_;
};

/// The scenario without uncertainty, for a Ranker that gets the motions of each world.
Scenario single_world(const Scenario& scenario) {
  Scenario single = likeliest_future(scenario);
  for (ScenarioActor& actor : single.actors) actor.existence_probability = 1.0;
  single.ego.uncertainty = {};
  return single;
}

const char* method_name(FutureMethod method) {
  switch (method) {
    case FutureMethod::joint:
      return "joint";
    case FutureMethod::all:
      return "all";
    case FutureMethod::sampled:
      return "sampled";
    case FutureMethod::certain:
      break;
  }
  return "certain";
}

void refuse(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  std::exit(1);
}

/// Prints a line; returns how far the two answers are from each other at most, in errors of their
/// difference.
double compare(const std::string& file, const Options& o) {
  Result<bench::Situations> made = bench::make_situations(file, 0, 1, 1);
  if (!made) refuse(made.error());
  Scenario& scenario = made->scenario;
  if (o.listed > 0 && scenario.listed.size() > o.listed) scenario.listed.resize(o.listed);
  if (o.listed == 0) {
    scenario.listed.clear();
    scenario.grid = CandidateGrid{};
  }
  const View<const Model> models{made->models.data(), made->models.size()};
  Result<std::vector<Candidate>> candidates = make_candidates(
      scenario, static_cast<double>(models[scenario.ego.model].mesh.bounds().extent().x()));
  if (!candidates) refuse(candidates.error());

  RankOptions plain;
  plain.harm = scenario.harm;
  plain.harm->intervals = false;
  plain.workers = o.workers;
  plain.sampled_futures = o.sampled;
  const Result<RankResult> stratified = rank(scenario, models, plain);
  if (!stratified) refuse(stratified.error());

  RankerOptions options;
  options.rank = plain;
  options.rank.infeasible = Infeasible::keep;
  const Scenario single = single_world(scenario);
  Result<Ranker> ranker = Ranker::prepare(single, models, options);
  if (!ranker) refuse(ranker.error());
  Worlds worlds(scenario, o.seed);
  // Scores of a world, by candidate.
  std::vector<double> scores(candidates->size());
  const auto rank_world = [&](const Choices& choices) {
    const Result<std::vector<Motion>> motions = worlds.motions(choices);
    if (!motions) refuse(motions.error());
    std::vector<Candidate> moved = *candidates;
    const StateError error = worlds.draw_error(scenario.ego.uncertainty);
    for (Candidate& candidate : moved) candidate.motion.displace(error);
    const Pose start = moved.front().motion.pose_at(0.0);
    const Status placed = ranker->move_actors(start, {motions->data(), motions->size()});
    if (!placed) refuse(placed.error());
    const RankerAnswer answer = ranker->rank({moved.data(), moved.size()});
    if (!answer.status) refuse(answer.status.error());
    for (const RankedCandidate& told : answer.ranking) scores[told.candidate] = told.score;
  };
  std::vector<Mean> means(candidates->size());
  std::map<Choices, std::vector<double>> known;
  const bool repeat = worlds.repeat();
  std::size_t drawn_worlds = 0;
  std::size_t ranked_worlds = 0;
  const auto begun = std::chrono::steady_clock::now();
  const auto in_time = [&] {
    const std::chrono::duration<double> past = std::chrono::steady_clock::now() - begun;
    return past.count() < o.seconds;
  };
  for (; drawn_worlds < o.worlds && in_time(); ++drawn_worlds) {
    const Choices choices = worlds.draw_choices();
    const auto before = repeat ? known.find(choices) : known.end();
    if (before == known.end() || o.check) rank_world(choices);
    if (before == known.end()) {
      ++ranked_worlds;
      if (repeat) known.emplace(choices, scores);
    } else if (o.check && scores != before->second) {
      refuse(make_error(ErrorCode::internal, "a repeated world has other scores", {}));
    } else {
      scores = before->second;
    }
    for (std::size_t i = 0; i < scores.size(); ++i) means[i].add(scores[i]);
  }

  double furthest = 0.0;
  const CandidateResult* furthest_told = nullptr;
  double widest = 0.0;
  double highest = 0.0;
  std::size_t beyond = 0;
  std::size_t compared = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (means[i].mean() < means[first].mean()) first = i;
  }
  for (const CandidateResult& told : stratified->ranking) {
    const Mean& mean = means[told.candidate];
    const double drawn = told.sampling_error.value_or(0.0);
    const double error = std::hypot(drawn, mean.error());
    const double away = std::abs(*told.score - mean.mean());
    highest = std::max(highest, mean.mean());
    widest = std::max(widest, away);
    if (error > 0.0) ++compared;
    // Scores of the same crash in two worlds differ by rounding, which no error states.
    constexpr double rounding = 1e-12;
    if (away <= rounding * mean.mean()) continue;
    if (away > 2.0 * error) ++beyond;
    if (away / error > furthest) {
      furthest = away / error;
      furthest_told = &told;
    }
  }
  std::printf("%s,%zu,%zu,%zu,%s,%zu,%zu,%.4g,%.4g,%zu,%zu,%.2f,%s\n", made->name.c_str(),
              means.size(), drawn_worlds, ranked_worlds, method_name(stratified->futures.method),
              stratified->futures.futures, compared, highest, widest, beyond,
              compared == 0 ? 0 : beyond * 100 / compared, furthest,
              stratified->ranking.front().candidate == first ? "yes" : "no");
  std::fflush(stdout);
  if (furthest_told != nullptr) {
    const Mean& mean = means[furthest_told->candidate];
    std::fprintf(stderr, "%s: furthest is \"%s\": %.4g +- %.2g sampled, %.4g +- %.2g drawn\n",
                 made->name.c_str(), (*candidates)[furthest_told->candidate].name.c_str(),
                 *furthest_told->score, furthest_told->sampling_error.value_or(0.0), mean.mean(),
                 mean.error());
  }
  return furthest;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CLI::App app("scores over a sample of futures beside worlds drawn one by one");
  app.add_option("scenarios", o.scenarios, "files with predictions or errors of states")
      ->required();
  app.add_option("--worlds", o.worlds, "drawn one by one");
  app.add_option("--seconds", o.seconds, "fewer worlds of a scenario where they take longer");
  app.add_option("--futures", o.sampled, "of the stratified sample");
  app.add_option("--listed", o.listed,
                 "so many of the listed candidates instead of the grid of 225");
  app.add_option("--seed", o.seed, "of the worlds");
  app.add_flag("--check", o.check, "rank repeated worlds again; other scores are an error");
  app.add_option("--workers", o.workers, "threads");
  CLI11_PARSE(app, argc, argv);
  std::printf(
      "scenario,candidates,worlds,different worlds,method,futures,with an error,highest "
      "score,widest,beyond two "
      "errors,in percent,furthest in errors,same first\n");
  double furthest = 0.0;
  for (const std::string& file : o.scenarios) furthest = std::max(furthest, compare(file, o));
  // Of some thousand comparisons hardly one is further than five standard errors by chance.
  return furthest > 5.0 ? 1 : 0;
}
