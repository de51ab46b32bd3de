// How the time of a ranking grows with the bodies around the ego, with the candidates and with the
// threads, and what a body costs that nothing reaches: CSV and a chart.
#include "bench/rank/situations.hpp"

#include "bench/timing.hpp"
#include "crashrank/rank/anytime/ranker.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using namespace crashrank;

struct Options {
  std::string scenario;
  std::string svg;
  std::vector<std::size_t> others{5, 10, 20, 40, 80};
  std::vector<std::size_t> sides{5, 15, 30, 45};
  std::vector<unsigned> workers{1, 2};
  std::size_t near = 20;
  std::size_t calls = 3;
};

struct Row {
  std::size_t others = 0;
  std::size_t far = 0;  ///< of them, which nothing reaches
  std::size_t candidates = 0;
  unsigned workers = 1;
  double first_ms = 0.0;  ///< until the first place is proved
  double all_ms = 0.0;    ///< until all scores are known
};

/// Repeats the scenario's others, nearest first, every 60 m; the last `far` of them 10 km away.
Scenario with_others(Scenario scenario, std::size_t others, std::size_t far) {
  std::vector<ScenarioActor> cast = std::move(scenario.actors);
  scenario.actors.clear();
  std::stable_sort(cast.begin(), cast.end(), [](const ScenarioActor& p, const ScenarioActor& q) {
    return p.pose.translation.norm() < q.pose.translation.norm();
  });
  for (std::size_t i = 0; i < others; ++i) {
    ScenarioActor actor = cast[i % cast.size()];
    const auto again = static_cast<double>(i / cast.size());
    actor.pose.translation.x() += 60.0 * again + (i + far >= others ? 1e4 : 0.0);
    actor.name += " " + std::to_string(i);
    scenario.actors.push_back(std::move(actor));
  }
  return scenario;
}

bool measure(const bench::Situations& base, std::size_t calls, std::size_t side, Row& row) {
  bench::Situations s = base;
  s.scenario = with_others(base.scenario, row.others, row.far);
  s.scenario.grid = CandidateGrid{side, side};
  const double length_m = s.models[s.scenario.ego.model].mesh.bounds().extent().x();
  Result<std::vector<Candidate>> candidates = make_candidates(s.scenario, length_m);
  if (!candidates) return false;
  s.candidates = std::move(*candidates);
  row.candidates = s.candidates.size();
  RankerOptions how;
  how.rank.workers = row.workers;
  how.limits.candidates = s.candidates.size();
  how.limits.actors = std::max<std::size_t>(row.others, 1);
  Result<Ranker> ranker = Ranker::prepare(s.scenario, s.models, how);
  if (!ranker) return false;
  for (const bool first : {true, false}) {
    RankBudget budget;
    budget.first_place_only = first;
    std::vector<double> ms;
    for (std::size_t i = 0; i < calls; ++i) {
      ms.push_back(1e3 * ranker->rank(s.candidates, budget).elapsed_s);
    }
    (first ? row.first_ms : row.all_ms) = bench::median(ms);
  }
  std::printf("%zu,%zu,%zu,%u,%.3f,%.3f\n", row.others, row.far, row.candidates, row.workers,
              row.first_ms, row.all_ms);
  std::fflush(stdout);
  return true;
}

/// All scores over the others, both logarithmic: a line for each number of candidates, dashed for
/// more than one thread.
void draw(const std::vector<Row>& rows, std::FILE* file) {
  constexpr double width = 640.0;
  constexpr double height = 400.0;
  double least = INFINITY;
  double most = 0.0;
  double fewest = INFINITY;
  double largest = 0.0;
  for (const Row& row : rows) {
    least = std::min(least, row.all_ms);
    most = std::max(most, row.all_ms);
    fewest = std::min(fewest, static_cast<double>(row.others));
    largest = std::max(largest, static_cast<double>(row.others));
  }
  const auto x = [&](double others) {
    return 60.0 + (width - 200.0) * std::log(others / fewest) / std::log(largest / fewest + 1e-9);
  };
  const auto y = [&](double ms) {
    return height - 40.0 - (height - 80.0) * std::log(ms / least) / std::log(most / least + 1e-9);
  };
  std::fprintf(file,
               "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" "
               "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%%\" "
               "height=\"100%%\" fill=\"#ffffff\"/>\n<text x=\"10\" y=\"20\">All scores, ms, over "
               "the others, both logarithmic; dashed: more threads; rings: some far away"
               "</text>\n",
               width, height);
  for (double ms = std::pow(10.0, std::ceil(std::log10(least))); ms <= most; ms *= 10.0) {
    std::fprintf(file, "<text x=\"52\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n", y(ms), ms);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const double at = x(static_cast<double>(row.others));
    std::fprintf(file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\" stroke=\"#0b5394\"/>\n",
                 at, y(row.all_ms), row.far > 0 ? "#ffffff" : "#0b5394");
    std::fprintf(file, "<text x=\"%.1f\" y=\"%g\" text-anchor=\"middle\">%zu</text>\n", at,
                 height - 16.0, row.others);
    const bool goes_on = i + 1 < rows.size() && row.far == 0 && rows[i + 1].far == 0 &&
                         rows[i + 1].others > row.others;
    if (goes_on) {
      std::fprintf(
          file, "<path d=\"M%.1f %.1fL%.1f %.1f\" stroke=\"#0b5394\" stroke-dasharray=\"%s\"/>\n",
          at, y(row.all_ms), x(static_cast<double>(rows[i + 1].others)), y(rows[i + 1].all_ms),
          row.workers > 1 ? "6 4" : "");
    } else if (row.far == 0 && row.workers == 1) {
      std::fprintf(file, "<text x=\"%.1f\" y=\"%.1f\">%zu candidates</text>\n", at + 8.0,
                   y(row.all_ms), row.candidates);
    }
  }
  std::fprintf(file, "</svg>\n");
}

int run(const Options& options) {
  const Result<bench::Situations> base = bench::make_situations(options.scenario, 0, 1, 7);
  if (!base) {
    std::fprintf(stderr, "%s\n", base.error().message().c_str());
    return 3;
  }
  std::vector<Row> rows;
  std::printf("others,out_of_reach,candidates,threads,first_place_ms,all_scores_ms\n");
  for (const std::size_t side : options.sides) {
    for (const unsigned workers : options.workers) {
      for (const bool far : {false, true}) {
        for (const std::size_t others : options.others) {
          if (far && others <= options.near) continue;
          Row row{others, far ? others - options.near : 0, 0, workers, 0.0, 0.0};
          if (!measure(*base, options.calls, side, row)) return 3;
          rows.push_back(row);
        }
      }
    }
  }
  if (options.svg.empty()) return 0;
  std::FILE* const file = std::fopen(options.svg.c_str(), "w");
  if (file == nullptr) return 3;
  draw(rows, file);
  return std::fclose(file) == 0 ? 0 : 3;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("How ranking times grow: CSV and a chart");
  app.add_option("SCENARIO", options.scenario, "Its others are repeated")->required();
  app.add_option("--others", options.others)->delimiter(',');
  app.add_option("--sides", options.sides, "Candidates are a grid of each squared")->delimiter(',');
  app.add_option("--workers", options.workers)->delimiter(',');
  app.add_option("--near", options.near, "Others in reach where the rest is out of reach");
  app.add_option("--calls", options.calls, "The median counts");
  app.add_option("--svg", options.svg, "File of the chart");
  CLI11_PARSE(app, argc, argv);
  return run(options);
}
