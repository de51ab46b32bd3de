// How a query grows with the mesh.

#include "bench/query_bench.hpp"

#include "crashrank/internal/report/table.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <cstdio>

namespace bench {
namespace {

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

}  // namespace

// The poses are those of one size: the bodies meet along the same curves at every size, and what
// grows is the number of triangles along them.
bool grow(const Options& options) {
  std::vector<std::size_t> sizes = options.triangles;
  if (sizes.empty()) sizes = {10'000, 20'000, 50'000, 100'000, 200'000, 500'000};
  auto reference =
      make_workload("sedan", shipped_model("sedan", 100'000), options.poses, options.seed);
  if (!reference) {
    std::fprintf(stderr, "%s\n", reference.error().message().c_str());
    return false;
  }
  std::vector<Contestant> contestants(sizes.size());
  std::vector<double> triangles;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const TriangleMesh mesh = shipped_model("sedan", sizes[i]);
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

}  // namespace bench
