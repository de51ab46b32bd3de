#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/internal/tree/build_records.hpp"
#include "crashrank/internal/tree/greedy_build.hpp"
#include "crashrank/internal/tree/tree_writer.hpp"

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace crashrank::detail {

/// Below this many triangles a tree is built before a second thread has begun to help.
inline constexpr std::size_t min_parallel_triangles = 4096;

/// Calls `work(index)` for different indices below `count` on up to that many threads, the calling
/// one with 0, and returns when all are done: `work` has to share out what there is to do. Throws
/// what one of them threw.
template <class Work> void on_threads(std::uint32_t count, const Work& work) {
  std::vector<std::exception_ptr> thrown(std::max(count, 1U));
  const auto guarded = [&work, &thrown](std::uint32_t index) {
    try {
      work(index);
    } catch (...) {
      thrown[index] = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  threads.reserve(std::max(count, 1U) - 1);
  try {
    for (std::uint32_t i = 1; i < count; ++i) threads.emplace_back(guarded, i);
  } catch (const std::exception&) {
    // No more threads, or no memory for one, to be had: those that run share the work.
  }
  guarded(0);
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& exception : thrown) {
    if (exception) std::rethrow_exception(exception);
  }
}

/// Calls `work(first, last)` over equal slices of 0 to size, on up to `threads` threads. Every
/// slice is worked on even where fewer threads could be started.
template <class Work> void on_slices(std::size_t size, std::uint32_t threads, const Work& work) {
  if (threads <= 1) return work(std::size_t{0}, size);
  std::mutex mutex;
  std::uint32_t next = 0;
  on_threads(threads, [&](std::uint32_t) {
    while (true) {
      std::uint32_t slice = 0;
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (next == threads) return;
        slice = next++;
      }
      work(size * slice / threads, size * (slice + 1) / threads);
    }
  });
}

/// Builds by `Rule` on several threads. Nodes above a grain are cut one by one by whichever thread
/// is free, the largest waiting one first; smaller ones are built whole. A cut depends on nothing
/// but the records of its node and their order, and threads never share records, so the tree has
/// the same bits as a serial one.
template <class Rule> class ParallelBuilder {
public:
  ParallelBuilder(const BuildArrays& arrays, const LeafLimits& leaves)
      : arrays_(arrays), leaves_(leaves) {}

  /// Returns the depth. `slots` is called with runs of slots whose order is final, by whichever
  /// thread finished them, and asked to get ready while there is nothing else to do.
  template <class Slots>
  std::uint32_t build(const Box& root, std::uint32_t threads, std::vector<Node>& nodes,
                      Slots& slots) {
    const auto count = static_cast<std::uint32_t>(arrays_.order.size());
    grain_ = std::max(count / (16 * threads), 1024U);
    pieces_.push_back({{}, root, 0, count, 0, 0, {0, 0}});
    waiting_.push_back(0);
    unfinished_ = 1;
    on_threads(threads, [this, &slots](std::uint32_t index) {
      try {
        if (index == 1) slots.prepare();
        work(slots);
      } catch (...) {
        stop();
        throw;
      }
    });
    assemble(nodes);
    return deepest_;
  }

private:
  /// A subtree: built whole into `nodes`, or cut once with two other pieces below.
  struct Piece {
    std::vector<Node> nodes;
    Box box;
    std::uint32_t first;
    std::uint32_t count;
    std::uint32_t depth;
    std::uint32_t buffer;
    std::uint32_t child[2];  ///< pieces; 0 where built whole
  };

  template <class Slots> void work(Slots& slots) {
    GreedyBuilder<Rule> builder(arrays_, leaves_);
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return !waiting_.empty() || unfinished_ == 0 || stopped_; });
      if (unfinished_ == 0 || stopped_) return;
      const auto largest =
          std::max_element(waiting_.begin(), waiting_.end(),
                           [this](auto a, auto b) { return pieces_[a].count < pieces_[b].count; });
      const std::uint32_t index = *largest;
      waiting_.erase(largest);
      Piece piece = std::move(pieces_[index]);
      lock.unlock();
      const bool whole = piece.count <= grain_;
      TreeWriter writer(piece.nodes);
      if (whole) piece.nodes.reserve(piece.count);
      writer.open_root(piece.box, piece.first, piece.count, piece.depth, piece.buffer);
      if (whole) {
        builder.build(writer);
        slots.fill(piece.first, piece.first + piece.count);
      } else {
        OpenNode open{};
        writer.next(open);
        builder.decide(writer, open);
      }
      lock.lock();
      finish(index, piece, writer, whole);
    }
  }

  void finish(std::uint32_t index, Piece& piece, TreeWriter& writer, bool whole) {
    if (!whole) {
      OpenNode open{};
      for (std::uint32_t side = 0; writer.next(open); ++side) {
        piece.child[side] = static_cast<std::uint32_t>(pieces_.size());
        pieces_.push_back(
            {{}, writer.box(open), open.first, open.count, open.depth, open.buffer, {0, 0}});
        waiting_.push_back(piece.child[side]);
        ++unfinished_;
      }
    }
    deepest_ = std::max(deepest_, writer.deepest());
    pieces_[index] = std::move(piece);
    --unfinished_;
    changed_.notify_all();
  }

  void stop() {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }

  /// Strings the pieces together in the order of the layout.
  void assemble(std::vector<Node>& nodes) const {
    std::size_t total = 1;
    for (const Piece& piece : pieces_) total += piece.nodes.size() - 1;
    nodes.reserve(total);
    nodes.push_back({});
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0U, 0U}};  // piece, node
    while (!open.empty()) {
      const auto [index, node] = open.back();
      open.pop_back();
      const Piece& piece = pieces_[index];
      const auto added = static_cast<std::uint32_t>(nodes.size());
      nodes[node] = piece.nodes[0];
      // A piece's own indices begin at 1 below its root; here they begin at `added`.
      if (!nodes[node].is_leaf()) nodes[node].first = added;
      for (std::size_t i = 1; i < piece.nodes.size(); ++i) {
        nodes.push_back(piece.nodes[i]);
        if (!nodes.back().is_leaf()) nodes.back().first += added - 1;
      }
      if (piece.child[0] != 0) {
        open.emplace_back(piece.child[1], added + 1);
        open.emplace_back(piece.child[0], added);
      }
    }
  }

  BuildArrays arrays_;
  LeafLimits leaves_;
  std::uint32_t grain_ = 0;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> waiting_;
  std::size_t unfinished_ = 0;
  std::uint32_t deepest_ = 0;
  bool stopped_ = false;  ///< a thread has thrown
};

}  // namespace crashrank::detail
