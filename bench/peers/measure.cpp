#include "measure.hpp"

#include "bench/timing.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

namespace peers {
namespace {

using bench::median;
using bench::now_s;

// Keeps the answers from being optimised away, and is what the compiler cannot know.
volatile std::size_t sink = 0;

void ask(Peer& peer, Mode mode, const Pose& pose) {
  sink = mode == Mode::any ? static_cast<std::size_t>(peer.any(pose)) : peer.all(pose);
}

// Times of one query in seconds, each over enough repeats for the clock to tell.
void sample(Peer& peer, Mode mode, const Pose& pose, double budget_s, std::vector<double>& times) {
  peer.bake(pose);
  double start = now_s();
  ask(peer, mode, pose);
  const double first = now_s() - start;
  if (first > budget_s) {
    times.push_back(first);
    return;
  }
  // Reading the clock takes as long as a short query, and the first one may be cold.
  int repeats = 1;
  double once = first;
  for (double took = 0.0; took < 10e-6; repeats *= 2) {
    start = now_s();
    for (int k = 0; k < repeats; ++k) ask(peer, mode, pose);
    took = now_s() - start;
    once = took / repeats;
  }
  const int samples =
      std::clamp(static_cast<int>(budget_s / (once * static_cast<double>(repeats))), 1, 15);
  for (int i = 0; i < samples; ++i) {
    start = now_s();
    for (int k = 0; k < repeats; ++k) ask(peer, mode, pose);
    times.push_back((now_s() - start) / repeats);
  }
}

// One pass over all poses, seconds a query. Work left out of the timing is left out here too; where
// there is none the clock is read twice only, since reading it takes as long as a near query.
double pass(Peer& peer, const std::vector<Pose>& poses) {
  double total = 0.0;
  if (peer.bakes()) {
    for (const Pose& pose : poses) {
      peer.bake(pose);
      const double start = now_s();
      ask(peer, Mode::cycled, pose);
      total += now_s() - start;
    }
  } else {
    const double start = now_s();
    for (const Pose& pose : poses) ask(peer, Mode::cycled, pose);
    total = now_s() - start;
  }
  return total / static_cast<double>(poses.size());
}

std::vector<Pair> sorted_pairs(Peer& peer, const Pose& pose) {
  peer.bake(pose);
  peer.all(pose);
  std::vector<Pair> pairs;
  peer.pairs(pairs);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

bool wanted(const std::vector<std::string>& names, const char* name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

std::uint64_t without(const std::vector<Pair>& from, const std::vector<Pair>& what) {
  std::vector<Pair> rest;
  std::set_difference(from.begin(), from.end(), what.begin(), what.end(), std::back_inserter(rest));
  return rest.size();
}

class Run {
public:
  Run(const Workload& workload, std::vector<std::unique_ptr<Peer>>& peers,
      const MeasureOptions& options)
      : workload_(workload), peers_(peers), options_(options) {}

  std::vector<Row> rows() {
    for (std::size_t p = 0; p < peers_.size(); ++p) {
      say(("preparing " + peers_[p]->name()).c_str());
      peers_[p]->prepare(workload_.mesh, workload_.mesh);
    }
    for (std::size_t r = 0; r < regime_count; ++r) {
      if (!wanted(options_.regimes, regime_names[r])) continue;
      for (const Mode mode : {Mode::all, Mode::any, Mode::cycled}) {
        if (!wanted(options_.modes, mode_names[static_cast<std::size_t>(mode)])) continue;
        say((std::string(regime_names[r]) + " / " + mode_names[static_cast<std::size_t>(mode)])
                .c_str());
        measure_mode(static_cast<Regime>(r), mode);
      }
    }
    say("");
    return std::move(rows_);
  }

private:
  void say(const char* what) const {
    if (options_.progress) std::fprintf(stderr, "\r%s: %-40s", workload_.name.c_str(), what);
  }

  bool takes_part(const Peer& peer, Mode mode) const { return mode != Mode::any || peer.has_any(); }

  void measure_mode(Regime regime, Mode mode) {
    const std::vector<Pose>& poses = workload_.poses[static_cast<std::size_t>(regime)];
    std::vector<std::vector<double>> medians(peers_.size());
    if (mode == Mode::cycled) {
      for (int round = 0; round < 2 * options_.rounds + 1; ++round) {
        for (std::size_t p = 0; p < peers_.size(); ++p) {
          const double first = pass(*peers_[p], poses);
          const double whole = first * static_cast<double>(poses.size());
          medians[p].push_back(whole > options_.budget_s ? first : pass(*peers_[p], poses));
        }
      }
    } else {
      for (const Pose& pose : poses) {
        std::vector<std::vector<double>> times(peers_.size());
        for (int round = 0; round < options_.rounds; ++round) {
          for (std::size_t p = 0; p < peers_.size(); ++p) {
            if (takes_part(*peers_[p], mode)) {
              sample(*peers_[p], mode, pose, options_.budget_s, times[p]);
            }
          }
        }
        for (std::size_t p = 0; p < peers_.size(); ++p) {
          if (times[p].empty()) continue;
          medians[p].push_back(*std::min_element(times[p].begin(), times[p].end()));
        }
      }
    }
    std::vector<Row> rows;
    for (std::size_t p = 0; p < peers_.size(); ++p) {
      if (!takes_part(*peers_[p], mode)) continue;
      rows.push_back({workload_.name, workload_.mesh.size(), regime, mode, peers_[p]->name(),
                      1e6 * median(medians[p]), 0, 0, 0});
      count(rows.back(), *peers_[p], poses);
    }
    rows_.insert(rows_.end(), rows.begin(), rows.end());
  }

  // peers_[0] is crashrank's scalar engine, whose pair sets the exactness campaigns vouch for.
  void count(Row& row, Peer& peer, const std::vector<Pose>& poses) const {
    for (const Pose& pose : poses) {
      if (row.mode == Mode::any) {
        const bool truth = peers_[0]->any(pose);
        const bool answer = peer.any(pose);
        row.pairs += static_cast<std::uint64_t>(answer);
        row.missed += static_cast<std::uint64_t>(truth && !answer);
        row.invented += static_cast<std::uint64_t>(answer && !truth);
        continue;
      }
      const std::vector<Pair> truth = sorted_pairs(*peers_[0], pose);
      const std::vector<Pair> answer = sorted_pairs(peer, pose);
      row.pairs += answer.size();
      row.missed += without(truth, answer);
      row.invented += without(answer, truth);
    }
  }

  const Workload& workload_;
  std::vector<std::unique_ptr<Peer>>& peers_;
  MeasureOptions options_;
  std::vector<Row> rows_;
};

}  // namespace

std::vector<Row> measure(const Workload& workload, std::vector<std::unique_ptr<Peer>>& peers,
                         const MeasureOptions& options) {
  return Run(workload, peers, options).rows();
}

}  // namespace peers
