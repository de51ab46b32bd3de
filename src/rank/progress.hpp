#pragma once

#include "crashrank/rank/rank.hpp"
#include "rank/evaluate.hpp"

#include <atomic>
#include <cstddef>

namespace crashrank::detail {

/// Counts evaluated candidates and calls RankOptions::on_progress. Shared by the workers of one
/// ranking. It and the options must outlive the scratch memory that refers to them.
class RankProgress {
public:
  RankProgress(const RankOptions& options, std::size_t candidates)
      : options_(options), candidates_(candidates) {}

  /// Makes evaluations with this scratch memory stop once the ranking is cancelled.
  void attach_to(Scratch& scratch) {
    if (!options_.on_progress) return;
    scratch.stop = {[](void* self) { return static_cast<RankProgress*>(self)->is_cancelled(); },
                    this};
  }

  /// Counts one evaluated candidate.
  void advance() {
    ++evaluated_;
    is_cancelled();
  }

private:
  bool is_cancelled() {
    if (options_.on_progress && !cancelled_ && !options_.on_progress(evaluated_, candidates_))
      cancelled_ = true;
    return cancelled_;
  }

  const RankOptions& options_;
  std::size_t candidates_;
  std::atomic<std::size_t> evaluated_{0};
  std::atomic<bool> cancelled_{false};
};

}  // namespace crashrank::detail
