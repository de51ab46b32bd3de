#include "rank/combine_futures.hpp"

#include "rank/hits.hpp"
#include "rank/measure_table.hpp"
#include "rank/sampling_error.hpp"

#include <algorithm>
#include <utility>

namespace crashrank::detail {
namespace {

/// Sets the intervals to the range of the score and of its samples; for harm only samples with the
/// chosen risk model count.
void add_intervals(const Scene& scene, CandidateResult& result) {
  result.score_interval = {*result.score, *result.score};
  result.numerical_interval = result.score_interval;
  const bool counts_people = measure_row(scene.measure).counts_people;
  for (std::size_t i = 0; i < result.sample_scores.size(); ++i) {
    const HarmSample& sample = scene.samples[i];
    if (counts_people && sample.model != scene.harm.model) continue;
    const double score = result.sample_scores[i];
    ScoreInterval& interval =
        is_numerical(sample) ? result.numerical_interval : result.score_interval;
    interval.lowest = std::min(interval.lowest, score);
    interval.highest = std::max(interval.highest, score);
  }
}

/// Sort key: the ego precedes all actors.
std::size_t rank_of_body(std::size_t body) { return body + 1; }

/// Mean risk of the people of each body over all futures.
std::vector<PersonRisk> mean_risks(const std::vector<CandidateResult>& results,
                                   const std::vector<SimulatedOutcome>& outcomes) {
  std::vector<PersonRisk> people;
  for (std::size_t k = 0; k < results.size(); ++k) {
    for (PersonRisk risk : results[k].people) {
      risk.probability *= outcomes[k].summary.probability;
      const auto same = std::find_if(people.begin(), people.end(), [&](const PersonRisk& each) {
        return each.body == risk.body;
      });
      if (same == people.end()) {
        // The exposure is that of the likeliest future.
        if (k > 0) risk.exposure_mps = risk.exposure_pdof_deg = risk.exposure_time_s = 0.0;
        people.push_back(risk);
      } else {
        same->probability = std::min(same->probability + risk.probability, 1.0);
      }
    }
  }
  static_assert(ego_body + 1 == 0);
  std::sort(people.begin(), people.end(), [](const PersonRisk& p, const PersonRisk& q) {
    return rank_of_body(p.body) < rank_of_body(q.body);
  });
  return people;
}

}  // namespace

double risk_of_futures(const Scene& scene, View<const double> scores,
                       std::vector<WeightedScore>& weighted) {
  weighted.clear();
  for (std::size_t f = 0; f < scores.size(); ++f) {
    weighted.push_back({scores[f], scene.futures.probability(f)});
  }
  return risk_of(scene.futures.summary.risk, weighted);
}

CandidateResult combine_futures(const Scene& scene, std::vector<CandidateResult>&& results,
                                const std::vector<SimulatedOutcome>& outcomes, double upper_bound,
                                Scratch& scratch) {
  const FutureSummary& summary = scene.futures.summary;
  std::vector<double> scores(scene.futures.size());
  const auto risk_over = [&](const auto& score_of) {
    for (std::size_t k = 0; k < results.size(); ++k) {
      for (const std::uint32_t f : outcomes[k].futures) scores[f] = score_of(k);
    }
    return risk_of_futures(scene, {scores.data(), scores.size()}, scratch.weighted);
  };
  std::vector<double> samples;
  for (std::size_t i = 0; i < scene.samples.size(); ++i) {
    samples.push_back(
        risk_over([&results, i](std::size_t k) { return results[k].sample_scores[i]; }));
  }
  std::vector<FutureOutcome> summaries;
  for (std::size_t k = 0; k < results.size(); ++k) {
    summaries.push_back(outcomes[k].summary);
    summaries.back().score = *results[k].score;
  }
  std::stable_sort(
      summaries.begin() + 1, summaries.end(),
      [](const FutureOutcome& p, const FutureOutcome& q) { return p.probability > q.probability; });
  const double highest = risk_over([&](std::size_t k) {
    return outcomes[k].summary.contact_without_force ? upper_bound : *results[k].score;
  });
  const double score = risk_over([&](std::size_t k) { return *results[k].score; });
  std::vector<PersonRisk> people = mean_risks(results, outcomes);
  CandidateResult combined = std::move(results.front());
  combined.people = std::move(people);
  combined.score = score;
  if (summary.method == FutureMethod::sampled) {
    // What no future has may change a score by more than the drawn ones differ.
    if (summary.undrawn == 0)
      combined.sampling_error = sampling_error(summary, {scores.data(), scores.size()});
    scores.resize(summary.sampled);
    combined.drawn_scores = std::move(scores);
  }
  combined.sample_scores = std::move(samples);
  combined.futures = std::move(summaries);
  for (std::size_t k = 1; k < results.size(); ++k) {
    combined.crowded = combined.crowded || results[k].crowded;
  }
  add_intervals(scene, combined);
  combined.score_interval.highest = std::max(combined.score_interval.highest, highest);
  return combined;
}

double collision_probability(const Scene& scene, const FutureGroup& group, const Scratch& scratch,
                             double before) {
  const Futures& futures = scene.futures;
  if (futures.size() == 1) return first_hit(scene, scratch, 0) != nullptr ? 1.0 : 0.0;
  double sum = before;
  for (std::size_t f = group.begin; f < group.end; ++f) {
    if (first_hit(scene, scratch, f) != nullptr) sum += futures.probability(f);
  }
  // Rounding can make the sum of all probabilities exceed 1.
  return std::min(sum, 1.0);
}

}  // namespace crashrank::detail
