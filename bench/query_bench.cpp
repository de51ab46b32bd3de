// Build and query times, work and memory of trees, per mesh and split rule, one body against a copy
// of itself; and how a query grows with the mesh. Times are processor time of one thread, the least
// of the rounds for a pose, then the median over the poses; the rules take turns at every pose.
//
//   query_bench [rules|growth] [--triangles N,...] [--rounds N] [--paper] [MESH...]

#include "bench/query_bench.hpp"

#include "crashrank/internal/report/table.hpp"
#include "crashrank/tree/build.hpp"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace bench;

/// What one box test and one triangle test take, s. In the vector engine a lane is a test.
struct TestCost {
  double box = 0.0;
  double triangle = 0.0;
  double of(const CollideWork& work) const {
    return box * static_cast<double>(work.bv_tests) +
           triangle * static_cast<double>(work.primitive_tests);
  }
};

/// Least squares of relative errors over every second pose of all contestants, neither below 0.
TestCost calibrate(const std::vector<Contestant>& contestants, Ask what) {
  double bb = 0.0;
  double bp = 0.0;
  double pp = 0.0;
  double b1 = 0.0;
  double p1 = 0.0;
  for (const Contestant& c : contestants) {
    for (std::size_t i = 0; i < c.deep(what).size(); i += 2) {
      const Sample& s = c.deep(what)[i];
      const double b = static_cast<double>(s.work.bv_tests) / s.seconds;
      const double p = static_cast<double>(s.work.primitive_tests) / s.seconds;
      bb += b * b;
      bp += b * p;
      pp += p * p;
      b1 += b;
      p1 += p;
    }
  }
  const double determinant = bb * pp - bp * bp;
  TestCost cost{(b1 * pp - p1 * bp) / determinant, (p1 * bb - b1 * bp) / determinant};
  if (!(cost.box > 0.0)) cost = {0.0, p1 / pp};
  if (!(cost.triangle > 0.0)) cost = {b1 / bb, 0.0};
  return cost;
}

void print_times(const Workload& load, std::vector<Contestant>& contestants) {
  const auto triangles = static_cast<double>(load.mesh.size());
  std::printf("\n%s, %zu triangles: times\n", load.name.c_str(), load.mesh.size());
  Table table({{"rule"},
               {"build ms", true},
               {"2 threads", true},
               {"depth", true},
               {"B/tri", true},
               {"B/tri read", true},
               {"scalar us", true},
               {"deep us", true},
               {"cycled us", true},
               {"any us", true},
               {"near us", true},
               {"far ns", true}});
  for (Contestant& c : contestants) {
    const double one = median(c.build_s);
    const double two = median(c.two_threads_s);
    const std::size_t all = c.model.tree.bytes() + c.model.wide.bytes();
    table.add_row(
        {c.name, number(1e3 * one, 2), number(1e3 * two, 2), std::to_string(c.model.tree.depth),
         number(static_cast<double>(all) / triangles, 0),
         number(static_cast<double>(c.model.wide.bytes()) / triangles, 0),
         number(1e6 * c.seconds(Regime::deep, Ask::scalar), 1),
         number(1e6 * c.seconds(Regime::deep, Ask::wide), 2), number(1e6 * median(c.cycled_s), 1),
         number(1e6 * c.seconds(Regime::deep, Ask::wide_any), 2),
         number(1e6 * c.seconds(Regime::near, Ask::wide), 2),
         number(1e9 * c.seconds(Regime::far, Ask::wide), 1)});
  }
  std::fputs(table.text().c_str(), stdout);
}

void print_cost(const Workload& load, const std::vector<Contestant>& contestants, Ask what) {
  const TestCost cost = calibrate(contestants, what);
  std::printf("\n%s, %s engine, deep: Cb %.2f ns, Cp %.2f ns from every second pose\n",
              load.name.c_str(), what == Ask::wide ? "vector" : "scalar", 1e9 * cost.box,
              1e9 * cost.triangle);
  Table table({{"rule"},
               {"Nb", true},
               {"Np", true},
               {"exact", true},
               {"pairs", true},
               {"Nb.Cb+Np.Cp us", true},
               {"of sah's", true},
               {"measured us", true},
               {"other poses: median off", true},
               {"most off", true}});
  double of_sah = 0.0;
  for (const Contestant& c : contestants) {
    if (c.name != "sah") continue;
    for (const Sample& s : c.deep(what)) of_sah += cost.of(s.work);
  }
  for (const Contestant& c : contestants) {
    CollideWork work;
    double seconds = 0.0;
    double pairs = 0.0;
    std::vector<double> off;
    double worst = 0.0;
    for (std::size_t i = 0; i < c.deep(what).size(); ++i) {
      const Sample& s = c.deep(what)[i];
      work += s.work;
      seconds += s.seconds;
      pairs += static_cast<double>(s.pairs);
      if (i % 2 == 0) continue;
      const double error = cost.of(s.work) / s.seconds - 1.0;
      off.push_back(std::abs(error));
      if (std::abs(error) > std::abs(worst)) worst = error;
    }
    const auto n = static_cast<double>(c.deep(what).size());
    table.add_row({c.name, number(static_cast<double>(work.bv_tests) / n, 0),
                   number(static_cast<double>(work.primitive_tests) / n, 0),
                   number(static_cast<double>(work.exact_tests) / n, 1), number(pairs / n, 0),
                   number(1e6 * cost.of(work) / n, 2), number(cost.of(work) / of_sah, 3),
                   number(1e6 * seconds / n, 2), number(100.0 * median(off), 1) + " %",
                   number(100.0 * worst, 1) + " %"});
  }
  std::fputs(table.text().c_str(), stdout);
}

struct Rule {
  const char* name;
  SplitRule rule;
};

void compare_rules(const Workload& load, const Options& options) {
  std::vector<Rule> rules{{"min-relative-segment", SplitRule::min_relative_segment},
                          {"sah", SplitRule::sah},
                          {"median", SplitRule::median}};
  if (options.paper) rules.push_back({"paper", SplitRule::paper});
  std::vector<Contestant> contestants(rules.size());
  for (std::size_t round = 0; round < options.rounds; ++round) {
    for (std::size_t r = 0; r < rules.size(); ++r) {
      if (rules[r].rule == SplitRule::paper && round > 0) continue;
      BuildOptions build;
      build.rule = rules[r].rule;
      double seconds = 0.0;
      contestants[r].name = rules[r].name;
      contestants[r].model = built(load.mesh, build, seconds);
      contestants[r].build_s.push_back(seconds);
      build.threads = 2;
      built(load.mesh, build, seconds);
      contestants[r].two_threads_s.push_back(seconds);
    }
  }
  for (std::size_t regime = 0; regime < regime_count; ++regime) {
    const std::vector<Pose>& poses = load.poses[regime];
    for (std::size_t i = 0; i < poses.size(); ++i) {
      for (std::size_t round = 0; round < options.rounds; ++round) {
        for (Contestant& c : contestants) {
          for (const Ask what : {Ask::wide, Ask::scalar, Ask::wide_any}) {
            c.measure(static_cast<Regime>(regime), what, poses, i);
          }
        }
      }
    }
  }
  for (std::size_t round = 0; round < 2 * options.rounds + 1; ++round) {
    for (Contestant& c : contestants) c.cycle(load.poses[0]);
  }
  print_times(load, contestants);
  print_cost(load, contestants, Ask::scalar);
  print_cost(load, contestants, Ask::wide);
}

bool run_rules(const Options& options) {
  std::vector<std::size_t> sizes = options.triangles;
  if (sizes.empty() && options.files.empty()) sizes = {10'000, 60'000, 100'000, 500'000};
  std::vector<Workload> loads;
  const auto add = [&](std::string name, TriangleMesh mesh) {
    auto load = make_workload(std::move(name), std::move(mesh), options.poses, options.seed);
    if (load) {
      compare_rules(*load, options);
    } else {
      std::fprintf(stderr, "%s\n", load.error().message().c_str());
    }
    return load.ok();
  };
  bool good = true;
  for (const std::size_t size : sizes) {
    const std::string car = size <= 20'000 ? "hatch" : "sedan";
    good = add(car, shipped_model(car, size)) && good;
  }
  std::vector<std::string> files = options.files;
  if (const char* more = std::getenv("CRASHRANK_BENCH_MESH"); more != nullptr) {
    files.emplace_back(more);
  }
  for (const std::string& file : files) {
    auto mesh = imported_mesh(file);
    if (mesh) {
      good = add(file.substr(file.find_last_of('/') + 1), std::move(*mesh)) && good;
    } else {
      std::fprintf(stderr, "%s\n", mesh.error().message().c_str());
      good = false;
    }
  }
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Build and query times per mesh and split rule"};
  CLI::App* rules = app.add_subcommand("rules", "times and work per mesh and split rule");
  CLI::App* growth = app.add_subcommand("growth", "query time against the size of the mesh");
  app.require_subcommand(1);
  for (CLI::App* sub : {rules, growth}) {
    sub->add_option("--triangles", options.triangles, "sizes of the shipped cars")->delimiter(',');
    sub->add_option("--poses", options.poses, "poses a regime");
    sub->add_option("--rounds", options.rounds, "rounds at every pose, and builds");
    sub->add_option("--seed", options.seed, "seed of the poses");
  }
  rules->add_flag("--paper", options.paper, "the literal rule too, which takes seconds to build");
  rules->add_option("mesh", options.files, "mesh files to measure on instead");
  app.footer("CRASHRANK_BENCH_MESH names a mesh file to measure on as well.");
  CLI11_PARSE(app, argc, argv);
  const bool good = growth->parsed() ? grow(options) : run_rules(options);
  return good ? 0 : 1;
}
