#include "report/score_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <utility>

namespace crashrank::detail {
namespace {

/// The decimal place of the first digit that an interval of that width leaves open.
int open_place(double width) { return static_cast<int>(std::floor(std::log10(width))); }

/// The decimal place of the first digit of a number other than 0.
int first_place(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)))); }

/// A number rounded to a decimal place.
std::string at_place(double value, int place) {
  if (value == 0.0 || !std::isfinite(value)) return fmt::format("{:g}", value);
  const int first = first_place(value);
  if (first < -5 || first >= 15) return fmt::format("{:.{}e}", value, std::max(first - place, 0));
  if (place < 0) return fmt::format("{:.{}f}", value, -place);
  const double step = std::pow(10.0, place);
  return fmt::format("{:.0f}", std::round(value / step) * step);
}

std::string without_trailing_zeros(std::string text) {
  if (text.find('.') == std::string::npos || text.find('e') != std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

double width_of(const CandidateResult& ranked) {
  return ranked.score_interval.highest - ranked.score_interval.lowest;
}

/// Differences of rounding are no interval.
bool is_open(const CandidateResult& ranked) {
  return width_of(ranked) > 1e-9 * std::abs(ranked.score_interval.highest);
}

/// A score and how many digits of it are printed; that of all rows which have it.
class PrintedScore {
public:
  explicit PrintedScore(double score) : score_(score) {
    if (score == 0.0 || !std::isfinite(score)) return;
    finest_ = first_place(score) - (most_score_digits - 1);
  }

  void add(const CandidateResult& ranked) {
    exact_ = exact_ || !is_open(ranked);
    if (finest_ == coarsest) return;
    const int first = first_place(score_);
    const int wanted =
        is_open(ranked) ? std::min(open_place(width_of(ranked)), first) : std::min(first - 4, 0);
    place_ = std::max(std::min(place_, wanted), finest_);
    print();
  }

  /// One digit more; false where it has the most.
  bool refine() {
    if (place_ <= finest_) return false;
    --place_;
    print();
    return true;
  }

  double score() const { return score_; }
  int place() const { return place_; }
  double shown() const { return shown_; }
  const std::string& text() const { return text_; }

private:
  static constexpr int coarsest = std::numeric_limits<int>::max();

  void print() {
    text_ = at_place(score_, place_);
    if (exact_) text_ = without_trailing_zeros(std::move(text_));
    shown_ = std::strtod(text_.c_str(), nullptr);
  }

  double score_;
  int finest_ = coarsest;
  int place_ = coarsest;
  bool exact_ = false;  ///< of a row whose interval leaves nothing open: no zeros at the end
  std::string text_ = at_place(score_, 0);
  double shown_ = score_;
};

/// Adds digits until every two neighbours print in their order. Each step adds one, so that it ends
/// after at most `most_score_digits` steps a score.
void keep_order(std::vector<PrintedScore>& scores) {
  for (std::size_t i = 0; i + 1 < scores.size();) {
    PrintedScore& a = scores[i];
    PrintedScore& b = scores[i + 1];
    const bool sound = !(a.score() < b.score()) || a.shown() < b.shown();
    // The coarser of the two first; two that are alike keep alike.
    const int place = std::max(a.place(), b.place());
    bool finer = false;
    if (!sound) {
      if (a.place() == place) finer = a.refine();
      if (b.place() == place) finer = b.refine() || finer;
      // The coarser one has all its digits: the other may have some left.
      if (!finer) finer = a.refine() || b.refine();
    }
    if (!finer) {
      ++i;
    } else if (i > 0) {
      --i;  // the one before was compared with fewer digits
    }
  }
}

/// The first few names of a tie.
std::string tied_names(const RankResult& result, std::size_t first, std::size_t count) {
  constexpr std::size_t shown = 5;
  std::string names;
  for (std::size_t i = 0; i < std::min(shown, count); ++i) {
    names += (i > 0 ? ", " : "") + result.candidates[result.ranking[first + i].candidate].name;
  }
  if (count > shown) names += fmt::format(" and {} more", count - shown);
  return names;
}

/// Why the order of two neighbours is not certain.
enum class Doubt { none, equal, samples, futures, numbers };

Doubt doubt_of_order(const CandidateResult& ranked, const CandidateResult& next) {
  if (ranked.separable || next.place == ranked.place || !ranked.score || !next.score) {
    return Doubt::none;
  }
  if (*ranked.score == *next.score) return Doubt::equal;
  if (ranked.overtaken > separable_share) return Doubt::samples;
  return ranked.within_sampling_error ? Doubt::futures : Doubt::numbers;
}

/// Neighbours in a row whose order is not certain for one reason.
struct Inseparable {
  Doubt doubt = Doubt::none;
  std::size_t first = 0;  ///< places
  std::size_t last = 0;
  std::size_t pairs = 0;
  double least_share = 1.0;  ///< of samples in which their order reverses
  double most_share = 0.0;

  void add(Doubt why, const CandidateResult& ranked, std::size_t next_place) {
    if (doubt == Doubt::none) first = ranked.place;
    doubt = why;
    last = next_place;
    ++pairs;
    least_share = std::min(least_share, ranked.overtaken);
    most_share = std::max(most_share, ranked.overtaken);
  }

  std::string reason(std::size_t samples) const {
    switch (doubt) {
      case Doubt::equal:
        return "equal scores";
      case Doubt::futures:
        return "another sample of futures may reverse the order";
      case Doubt::samples:
        break;
      default:
        return "longer steps or 1 mm aside may turn their order";
    }
    const std::string least = fmt::format("{:.0f}", 100.0 * least_share);
    const std::string most = fmt::format("{:.0f}", 100.0 * most_share);
    return fmt::format("the order reverses in {} % of {} samples",
                       least == most ? most : least + " to " + most, samples);
  }

  std::string words(std::size_t samples) const {
    return pairs == 1
               ? fmt::format("rank {} and {} not separable ({})", first, last, reason(samples))
               : fmt::format("rank {} to {} not separable from the next ({})", first, last,
                             reason(samples));
  }
};

}  // namespace

std::vector<std::string> score_texts(const RankResult& result) {
  std::vector<PrintedScore> scores;
  for (const CandidateResult& ranked : result.ranking) {
    if (!ranked.score) continue;
    if (scores.empty() || scores.back().score() != *ranked.score) {
      scores.emplace_back(*ranked.score);
    }
    scores.back().add(ranked);
  }
  keep_order(scores);
  std::vector<std::string> texts;
  std::size_t known = 0;
  for (const CandidateResult& ranked : result.ranking) {
    if (!ranked.score) {
      std::string text = fmt::format("{:.3g} to {:.3g}", ranked.score_interval.lowest,
                                     ranked.score_interval.highest);
      if (ranked.score_estimate) text += fmt::format(" (about {:.3g})", *ranked.score_estimate);
      texts.push_back(std::move(text));
      continue;
    }
    if (scores[known].score() != *ranked.score) ++known;
    texts.push_back(scores[known].text());
  }
  return texts;
}

std::string fixed_text(double value, int decimals) {
  const bool vanishes = value != 0.0 && std::abs(value) < 0.5 * std::pow(10.0, -decimals);
  return vanishes ? fmt::format("{:.1g}", value) : fmt::format("{:.{}f}", value, decimals);
}

std::string harm_text(double persons) {
  constexpr double least = 1e-4;
  if (persons > 0.0 && persons < least) return "under 0.0001";
  return fmt::format("{:.2g}", persons);
}

std::string in_kmh(const std::string& text) {
  constexpr std::string_view unit = " m/s";
  const auto ends_at = [&text](std::size_t at) {
    return at == text.size() || std::string_view(" ,.;:)").find(text[at]) != std::string::npos;
  };
  const auto begins_at = [&text](std::size_t at) {
    return at == 0 || text[at - 1] == ' ' || text[at - 1] == '(';
  };
  std::string out;
  bool in_name = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.compare(i, 3, "“") == 0 || (!in_name && text[i] == '\'' && begins_at(i))) {
      in_name = true;
    } else if (text.compare(i, 3, "”") == 0 || (text[i] == '\'' && ends_at(i + 1))) {
      in_name = false;
    }
    const std::size_t number = out.find_last_not_of("0123456789.") + 1;
    if (in_name || number == out.size() || text.compare(i, unit.size(), unit) != 0 ||
        !ends_at(i + unit.size())) {
      out += text[i];
      continue;
    }
    const double speed_mps = std::strtod(out.c_str() + number, nullptr);
    out.resize(number);
    out += fmt::format("{:.0f} km/h", 3.6 * speed_mps);
    i += unit.size() - 1;
  }
  return out;
}

std::string percent_text(double probability) {
  constexpr double half = 0.005;
  if (probability > 0.0 && probability < half) return "<1 %";
  if (probability < 1.0 && probability > 1.0 - half) return ">99 %";
  return fmt::format("{:.0f} %", 100.0 * probability);
}

std::string place_text(const CandidateResult& ranked) {
  return std::to_string(ranked.place) + (ranked.sharing > 1 ? " tied" : "");
}

std::string interval_text(const CandidateResult& ranked) {
  if (!ranked.score || !is_open(ranked)) return {};
  const int place = open_place(width_of(ranked));
  const double step = std::pow(10.0, place);
  // Bounds from energies are rounded up by a few parts in 1e9.
  constexpr double bound_slack = 1.0 - 1e-8;
  // An end that is a multiple of the step but for rounding stays there.
  constexpr double slack = 1e-9;
  const double lowest = ranked.score_interval.lowest;
  const auto low_end = [lowest](int at) {
    const double unit = std::pow(10.0, at);
    return std::floor(lowest / unit + slack) * unit;
  };
  // Harm that is certain does not print as 0.
  int low_place = place;
  if (lowest > 0.0 && !(low_end(place) > 0.0)) {
    low_place = static_cast<int>(std::floor(std::log10(lowest)));
  }
  return at_place(low_end(low_place), low_place) + " to " +
         at_place(std::ceil(bound_slack * ranked.score_interval.highest / step - slack) * step,
                  place);
}

std::string places_text(const CandidateResult& ranked) {
  if (ranked.best_place == ranked.worst_place) return std::to_string(ranked.best_place + 1);
  return fmt::format("{}-{}", ranked.best_place + 1, ranked.worst_place + 1);
}

std::vector<std::string> not_separable_words(const RankResult& result, std::size_t shown) {
  std::vector<std::string> words;
  Inseparable run;
  const auto tell = [&] {
    if (run.doubt != Doubt::none) words.push_back(run.words(range_sample_count(result)));
    run = {};
  };
  const std::size_t end = std::min(shown, result.ranking.size());
  for (std::size_t i = 0; i < end; ++i) {
    const CandidateResult& ranked = result.ranking[i];
    if (ranked.sharing > 1 && i + 1 == ranked.place) {
      tell();
      words.push_back(fmt::format("rank {}: {} candidates are tied ({})", ranked.place,
                                  ranked.sharing, tied_names(result, i, ranked.sharing)));
    }
    const Doubt doubt = i + 1 == end ? Doubt::none : doubt_of_order(ranked, result.ranking[i + 1]);
    if (doubt != run.doubt || run.last != ranked.place) tell();
    if (doubt != Doubt::none) run.add(doubt, ranked, result.ranking[i + 1].place);
  }
  tell();
  return words;
}

std::vector<std::string> harm_words(const HarmOptions& harm) {
  const HarmWeights& w = harm.weights;
  const HarmRanges& r = harm.ranges;
  std::vector<std::string> lines;
  lines.push_back(fmt::format(
      "Harm counts {} by the curves of {}; the weights are a choice of the user: ego "
      "occupant {:g}, other occupant {:g}, pedestrian {:g}, cyclist {:g}, motorcyclist {:g}, a MJ "
      "of deformation {:g}.",
      risk_outcome(harm.model), risk_model_name(harm.model), w.ego_occupant, w.other_occupant,
      w.pedestrian, w.cyclist, w.motorcyclist, w.property_per_mj));
  lines.push_back(
      fmt::format("People where the scenario states no occupants: {:g} in the ego, {:g} in a car, "
                  "{:g} in a truck, {:g} in a bus.",
                  w.people_in_ego, w.people_in_car, w.people_in_truck, w.people_in_bus));
  lines.push_back(fmt::format(
      "Friction {:g} ({:g} to {:g}); ranges: stiffness x {:g} to {:g}, restitution x {:g} to {:g}, "
      "speed of the risk curves x {:g} to {:g}, {}. After a contact whatever was hit {}.",
      harm.friction, r.least_friction, r.most_friction, r.least_strength, r.most_strength,
      r.least_restitution, r.most_restitution, r.least_risk_speed, r.most_risk_speed,
      r.all_models ? "order under all four risk models" : "this risk model alone",
      after_contact_name(harm.after_contact)));
  return lines;
}

}  // namespace crashrank::detail
