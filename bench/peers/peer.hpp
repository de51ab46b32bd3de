#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace peers {

using crashrank::Pair;
using crashrank::Pose;
using crashrank::TriangleMesh;

/// A collider in the side-by-side run. One thread; prepared once for two meshes, then asked pose by
/// pose. Results stay inside until `pairs` fetches them, which is not timed.
class Peer {
public:
  Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  virtual ~Peer() = default;

  virtual std::string name() const = 0;
  /// Builds whatever the peer keeps. `a` and `b` may be the same mesh and outlive the peer.
  virtual void prepare(const TriangleMesh& a, const TriangleMesh& b) = 0;
  /// Work that the peer needs for a pose before it can be asked and that its timing leaves out.
  /// Most have none: a bound that leaves work out says so in its name.
  virtual void bake(const Pose& /*b_in_a*/) {}
  virtual bool bakes() const { return false; }
  /// Finds all intersecting pairs, B at `b_in_a` in A's frame. Timed. Returns how many it reports.
  virtual std::size_t all(const Pose& b_in_a) = 0;
  /// Whether anything intersects, as early as the peer can tell. Timed.
  virtual bool any(const Pose& b_in_a) = 0;
  virtual bool has_any() const { return true; }
  /// The pairs of the last `all`, in any order, repeats allowed. Not timed.
  virtual void pairs(std::vector<Pair>& out) const = 0;
};

/// Every peer whose package was there at build time. The first is crashrank's scalar engine, whose
/// pair sets all others are held against.
std::vector<std::unique_ptr<Peer>> make_peers();

// One file each; called by make_peers alone.
std::unique_ptr<Peer> make_crashrank_scalar();
std::unique_ptr<Peer> make_crashrank();
std::unique_ptr<Peer> make_fcl();
std::unique_ptr<Peer> make_fcl_native(std::string& why_not);
std::unique_ptr<Peer> make_embree(bool baked_beforehand);
std::unique_ptr<Peer> make_bullet();
std::unique_ptr<Peer> make_cgal();
std::unique_ptr<Peer> make_ode();

}  // namespace peers
