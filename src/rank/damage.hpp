#pragma once

#include "crashrank/collide/collide.hpp"
#include "rank/scene.hpp"

#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// A set of triangle indices that is emptied at no cost and lists its members in order.
class TriangleSet {
public:
  void clear(std::size_t size) {
    if (stamps_.size() < size) stamps_.resize(size, 0);
    members_.clear();
    if (++stamp_ == 0) {
      stamps_.assign(stamps_.size(), 0);
      stamp_ = 1;
    }
  }
  void add(std::uint32_t triangle) {
    if (stamps_[triangle] == stamp_) return;
    stamps_[triangle] = stamp_;
    members_.push_back(triangle);
  }
  /// Rising.
  const std::vector<std::uint32_t>& sorted();

private:
  std::vector<std::uint32_t> stamps_;
  std::vector<std::uint32_t> members_;
  std::uint32_t stamp_ = 0;
};

/// Memory that reading damage reuses, one for each worker.
struct DamageScratch {
  std::vector<Pair> pairs;
  CollideWorkspace collide;
  TriangleSet ego;
  TriangleSet other;
  std::vector<Pose> met;  ///< poses of the other in the ego's frame at which surfaces met
};

/// Moves the two bodies on from a contact by the scene's crush and fills in what it does to both,
/// `contact.ego`, `contact.other` and how far they moved. `triangle_ego` and `triangle_other` met
/// first; negative when none did.
void read_damage(const Scene& scene, const Motion& ego_motion, Contact& contact,
                 std::int32_t triangle_ego, std::int32_t triangle_other, DamageScratch& scratch,
                 RankWork& work);

/// Fills in area and parts from the triangles.
void sum_up(const TriangleMesh& mesh, BodyDamage& damage);

}  // namespace crashrank::detail
