// Build and query times, work and memory of trees, per mesh and split rule, one body against a copy
// of itself; and how a query grows with the mesh. Times are processor time of one thread, the least
// of the rounds for a pose, then the median over the poses; the rules take turns at every pose.
//
//   query_bench [rules|growth] [--triangles N,...] [--rounds N] [--paper] [MESH...]

#include "bench/timing.hpp"
#include "bench/workload.hpp"

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/report/table.hpp"
#include "crashrank/tree/model.hpp"
#include "crashrank/tree/quality.hpp"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace crashrank;
using bench::Regime;
using bench::Workload;

struct Options {
  std::vector<std::size_t> triangles;
  std::vector<std::string> files;
  std::size_t poses = 20;
  std::size_t rounds = 5;
  std::uint64_t seed = 1;
  bool paper = false;
};

std::string number(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// One query at one pose: its least time and the work it did.
struct Sample {
  double seconds = 1e300;
  CollideWork work;
  std::size_t pairs = 0;
};

/// The two engines and the two questions.
enum class Ask { wide, scalar, wide_any };
constexpr std::size_t ask_count = 3;

struct Contestant {
  std::string name;
  Model model;
  std::vector<double> build_s;
  std::vector<double> two_threads_s;
  std::vector<Sample> samples[bench::regime_count][ask_count];
  std::vector<double> cycled_s;  // a query, deep, all pairs

  CollideResult ask(Ask what, const Pose& pose) {
    if (what == Ask::scalar) {
      return collide(model.tree, model.tree, pose, pairs_, workspace_.scalar);
    }
    return collide(model, model, pose, pairs_, workspace_, {what == Ask::wide_any});
  }
  void measure(Regime regime, Ask what, const std::vector<Pose>& poses, std::size_t index) {
    std::vector<Sample>& all =
        samples[static_cast<std::size_t>(regime)][static_cast<std::size_t>(what)];
    all.resize(poses.size());
    Sample& sample = all[index];
    int repeats = 1;
    for (double took = 0.0; took < 20e-6; repeats *= 2) {
      CollideResult result;
      const double start = bench::now_s();
      for (int k = 0; k < repeats; ++k) result = ask(what, poses[index]);
      took = bench::now_s() - start;
      sample.work = result.work;
      sample.pairs = result.pairs;
      if (took >= 20e-6) sample.seconds = std::min(sample.seconds, took / repeats);
    }
  }
  void cycle(const std::vector<Pose>& poses) {
    const double start = bench::now_s();
    for (const Pose& pose : poses) ask(Ask::wide, pose);
    cycled_s.push_back((bench::now_s() - start) / static_cast<double>(poses.size()));
  }
  double seconds(Regime regime, Ask what) const {
    std::vector<double> values;
    for (const Sample& s :
         samples[static_cast<std::size_t>(regime)][static_cast<std::size_t>(what)]) {
      values.push_back(s.seconds);
    }
    return bench::median(std::move(values));
  }
  const std::vector<Sample>& deep(Ask what) const {
    return samples[0][static_cast<std::size_t>(what)];
  }

private:
  std::vector<Pair> pairs_;
  ModelWorkspace workspace_;
};

Model built(const TriangleMesh& mesh, const BuildOptions& options, double& seconds) {
  const double start = bench::wall_s();
  Result<Model> model = make_model(mesh, options);
  seconds = bench::wall_s() - start;
  if (!model) {
    std::fprintf(stderr, "%s\n", model.error().message().c_str());
    std::exit(1);
  }
  return std::move(*model);
}

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
    const double one = bench::median(c.build_s);
    const double two = bench::median(c.two_threads_s);
    const std::size_t all = c.model.tree.bytes() + c.model.wide.bytes();
    table.add_row({c.name, number(1e3 * one, 2), number(1e3 * two, 2),
                   std::to_string(c.model.tree.depth),
                   number(static_cast<double>(all) / triangles, 0),
                   number(static_cast<double>(c.model.wide.bytes()) / triangles, 0),
                   number(1e6 * c.seconds(Regime::deep, Ask::scalar), 1),
                   number(1e6 * c.seconds(Regime::deep, Ask::wide), 2),
                   number(1e6 * bench::median(c.cycled_s), 1),
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
                   number(1e6 * seconds / n, 2), number(100.0 * bench::median(off), 1) + " %",
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
  for (std::size_t regime = 0; regime < bench::regime_count; ++regime) {
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

/// Least squares of y = c0·x0 + c1·x1 + ... by the normal equations; relative errors.
std::vector<double> fit(const std::vector<std::vector<double>>& x, const std::vector<double>& y) {
  const std::size_t n = x[0].size();
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(x.size()), static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = x[i][j] / y[i];
    }
  }
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(rows.rows());
  const Eigen::VectorXd solved = (rows.transpose() * rows).ldlt().solve(rows.transpose() * ones);
  return {solved.begin(), solved.end()};
}

// The poses are those of one size: the bodies meet along the same curves at every size, and what
// grows is the number of triangles along them.
bool grow(const Options& options) {
  std::vector<std::size_t> sizes = options.triangles;
  if (sizes.empty()) sizes = {10'000, 20'000, 50'000, 100'000, 200'000, 500'000};
  auto reference = bench::make_workload("sedan", bench::shipped_model("sedan", 100'000),
                                        options.poses, options.seed);
  if (!reference) {
    std::fprintf(stderr, "%s\n", reference.error().message().c_str());
    return false;
  }
  std::vector<Contestant> contestants(sizes.size());
  std::vector<double> triangles;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const TriangleMesh mesh = bench::shipped_model("sedan", sizes[i]);
    double seconds = 0.0;
    contestants[i].model = built(mesh, {}, seconds);
    triangles.push_back(static_cast<double>(mesh.size()));
  }
  const std::vector<Pose>& poses = reference->poses[0];
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t round = 0; round < options.rounds; ++round) {
      for (Contestant& c : contestants) c.measure(Regime::deep, Ask::wide, poses, i);
    }
  }
  Table table({{"triangles", true},
               {"pairs", true},
               {"us", true},
               {"ns/pair", true},
               {"fitted us", true},
               {"off", true}});
  std::vector<std::vector<double>> by_contacts;
  std::vector<std::vector<double>> by_power;
  std::vector<double> seconds;
  std::vector<double> logs;
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    double pairs = 0.0;
    double sum = 0.0;
    for (const Sample& s : contestants[i].deep(Ask::wide)) {
      pairs += static_cast<double>(s.pairs);
      sum += s.seconds;
    }
    const auto n = static_cast<double>(poses.size());
    by_contacts.push_back({pairs / n, std::log2(triangles[i])});
    seconds.push_back(sum / n);
  }
  const std::vector<double> c = fit(by_contacts, seconds);
  double mx = 0.0;
  double my = 0.0;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    mx += std::log(triangles[i]) / static_cast<double>(seconds.size());
    my += std::log(seconds[i]) / static_cast<double>(seconds.size());
  }
  double xy = 0.0;
  double xx = 0.0;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    const double dx = std::log(triangles[i]) - mx;
    xy += dx * (std::log(seconds[i]) - my);
    xx += dx * dx;
  }
  std::printf("sedan at %zu sizes, the same %zu deep poses (means)\n", sizes.size(), poses.size());
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    const double fitted = c[0] * by_contacts[i][0] + c[1] * by_contacts[i][1];
    table.add_row({number(triangles[i], 0), number(by_contacts[i][0], 0),
                   number(1e6 * seconds[i], 2), number(1e9 * seconds[i] / by_contacts[i][0], 1),
                   number(1e6 * fitted, 2), number(100.0 * (fitted / seconds[i] - 1.0), 1) + " %"});
  }
  std::fputs(table.text().c_str(), stdout);
  std::printf(
      "time = %.1f ns x pairs + %.0f ns x log2(triangles); as a power of the triangles: "
      "exponent %.3f\n",
      1e9 * c[0], 1e9 * c[1], xy / xx);
  return true;
}

bool run_rules(const Options& options) {
  std::vector<std::size_t> sizes = options.triangles;
  if (sizes.empty() && options.files.empty()) sizes = {10'000, 60'000, 100'000, 500'000};
  std::vector<Workload> loads;
  const auto add = [&](std::string name, TriangleMesh mesh) {
    auto load = bench::make_workload(std::move(name), std::move(mesh), options.poses, options.seed);
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
    good = add(car, bench::shipped_model(car, size)) && good;
  }
  std::vector<std::string> files = options.files;
  if (const char* more = std::getenv("CRASHRANK_BENCH_MESH"); more != nullptr) {
    files.emplace_back(more);
  }
  for (const std::string& file : files) {
    auto mesh = bench::imported_mesh(file);
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
