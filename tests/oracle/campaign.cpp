#include "oracle/campaign.hpp"

#include <cstdio>

namespace oracle {
namespace {

void print_pair(const TrianglePair& pair, bool answer, bool truth) {
  std::fprintf(stderr, "%s: answered %s, truth %s\n", name(pair.family), answer ? "yes" : "no",
               truth ? "yes" : "no");
  for (const Triangle* t : {&pair.a, &pair.b}) {
    for (const Point& p : *t) std::fprintf(stderr, "  %a %a %a\n", p[0], p[1], p[2]);
  }
}

void print_row(const char* label, const Tally& t) {
  std::printf("%-14s", label);
  for (const std::uint64_t count : {t.pairs, t.touching, t.missed[0], t.invented[0], t.missed[1],
                                    t.invented[1], t.oracles_differ, t.order_matters}) {
    std::printf(" %9llu", static_cast<unsigned long long>(count));
  }
  std::printf("\n");
}

}  // namespace

Tally& Tally::operator+=(const Tally& other) {
  pairs += other.pairs;
  touching += other.touching;
  oracles_differ += other.oracles_differ;
  order_matters += other.order_matters;
  for (std::size_t i = 0; i < 2; ++i) {
    missed[i] += other.missed[i];
    invented[i] += other.invented[i];
  }
  return *this;
}

Tally CampaignResult::all() const {
  Tally sum;
  for (const Tally& tally : family) sum += tally;
  return sum;
}

CampaignResult run_campaign(TriangleTest test, const CampaignOptions& options) {
  CampaignResult result;
  PairGenerator generator(options.seed, options.adversarial);
  int printed = 0;
  for (std::uint64_t n = 0; n < options.pairs; ++n) {
    if (options.progress && n % 50'000 == 0) {
      std::fprintf(stderr, "\r%5.1f %%",
                   100.0 * static_cast<double>(n) / static_cast<double>(options.pairs));
    }
    const TrianglePair pair = generator.next();
    const bool answer = test(pair.a, pair.b);
    const bool swapped = test(pair.b, pair.a);
    std::array<bool, 2> truth{answer, answer};
    if (options.rational) truth[0] = rational_intersects(pair.a, pair.b);
    if (options.cgal) truth[1] = cgal_intersects(pair.a, pair.b);
    Tally& tally = result.family[static_cast<std::size_t>(pair.family)];
    ++tally.pairs;
    if (options.rational ? truth[0] : truth[1]) ++tally.touching;
    if (swapped != answer) ++tally.order_matters;
    if (options.rational && options.cgal && truth[0] != truth[1]) ++tally.oracles_differ;
    for (std::size_t i = 0; i < 2; ++i) {
      if (truth[i] == answer) continue;
      ++(truth[i] ? tally.missed : tally.invented)[i];
      if (printed++ < options.print_first) print_pair(pair, answer, truth[i]);
    }
  }
  if (options.progress) std::fputs("\r        \r", stderr);
  return result;
}

void print(const CampaignResult& result) {
  std::printf("%-14s %9s %9s %19s %19s %9s %9s\n", "", "", "", "rational", "CGAL", "oracles",
              "order");
  std::printf("%-14s %9s %9s %9s %9s %9s %9s %9s %9s\n", "family", "pairs", "touching", "missed",
              "invented", "missed", "invented", "differ", "matters");
  for (std::size_t f = 0; f < family_count; ++f) {
    if (result.family[f].pairs != 0) print_row(name(static_cast<Family>(f)), result.family[f]);
  }
  print_row("all", result.all());
}

}  // namespace oracle
