// The exactness campaign: the library's triangle test against both oracles, as many pairs as there
// is time for.

#include "oracle/campaign.hpp"
#include "oracle/under_test.hpp"

#include <unistd.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  oracle::CampaignOptions options;
  std::string judge = "both";
  CLI::App app{"Holds crashrank's triangle test against exact oracles"};
  app.add_option("--pairs", options.pairs, "pairs to test; the nightly size is 10000000");
  app.add_option("--seed", options.seed, "seed of the stream of pairs");
  app.add_option("--adversarial", options.adversarial, "share of adversarial pairs")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--oracle", judge, "who judges")
      ->check(CLI::IsMember({"both", "rational", "cgal"}));
  CLI11_PARSE(app, argc, argv);
  options.rational = judge != "cgal";
  options.cgal = judge != "rational";
  options.progress = isatty(STDERR_FILENO) != 0;

  const auto start = std::chrono::steady_clock::now();
  const oracle::CampaignResult result = run_campaign(oracle::library_triangle_test, options);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  std::printf("seed %llu, oracle %s, %.1f s\n", static_cast<unsigned long long>(options.seed),
              judge.c_str(), elapsed.count());
  print(result);
  return result.all().clean() ? 0 : 1;
}
