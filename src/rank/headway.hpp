#pragma once

#include "crashrank/rank/rank.hpp"
#include "rank/evaluate.hpp"

#include <atomic>
#include <cstddef>

namespace crashrank::detail {

/// How far a ranking has come, told to its caller, who may end it: RankOptions::go_on. Its threads
/// share one. It and the options have to outlive what they watch.
class Headway {
public:
  Headway(const RankOptions& options, std::size_t candidates)
      : options_(options), candidates_(candidates) {}

  /// Lets the evaluations that use this memory ask; without a caller that wants to be asked they do
  /// not.
  void watch(Scratch& scratch) {
    if (!options_.go_on) return;
    scratch.stop = [](void* self) { return static_cast<Headway*>(self)->is_ended(); };
    scratch.stop_context = this;
  }

  /// One more candidate is evaluated.
  void advance() {
    ++evaluated_;
    is_ended();
  }

private:
  /// Once ended, it stays so.
  bool is_ended() {
    if (options_.go_on && !ended_ && !options_.go_on(evaluated_, candidates_)) ended_ = true;
    return ended_;
  }

  const RankOptions& options_;
  std::size_t candidates_;
  std::atomic<std::size_t> evaluated_{0};
  std::atomic<bool> ended_{false};
};

}  // namespace crashrank::detail
