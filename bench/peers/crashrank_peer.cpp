#include "crashrank/collide/collide.hpp"
#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"
#include "peer.hpp"

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

namespace peers {
namespace {

using SharedModel = std::shared_ptr<const crashrank::Model>;

SharedModel model_of(const TriangleMesh& mesh) {
  crashrank::Result<crashrank::Model> model = crashrank::make_model(mesh);
  if (!model) {
    std::fprintf(stderr, "%s\n", model.error().message().c_str());
    std::exit(1);
  }
  return std::make_shared<crashrank::Model>(std::move(*model));
}

/// The vector engine, which picks its instructions at run time.
class Crashrank final : public Peer {
public:
  std::string name() const override { return "crashrank"; }
  void prepare(const TriangleMesh& a, const TriangleMesh& b) override {
    a_ = model_of(a);
    b_ = &a == &b ? a_ : model_of(b);
    workspace_.prepare(*a_, *b_);
  }
  std::size_t all(const Pose& b_in_a) override {
    return collide(*a_, *b_, b_in_a, pairs_, workspace_).pairs;
  }
  bool any(const Pose& b_in_a) override {
    return collide(*a_, *b_, b_in_a, pairs_, workspace_, {true}).intersecting;
  }
  void pairs(std::vector<Pair>& out) const override { out = pairs_; }

private:
  SharedModel a_;
  SharedModel b_;
  std::vector<Pair> pairs_;
  crashrank::ModelWorkspace workspace_;
};

/// The header-only engine on the same binary trees. The reference for every pair set: it tests no
/// more than two boxes or two triangles at a time, the latter exactly.
class CrashrankScalar final : public Peer {
public:
  std::string name() const override { return "crashrank scalar"; }
  void prepare(const TriangleMesh& a, const TriangleMesh& b) override {
    a_ = model_of(a);
    b_ = &a == &b ? a_ : model_of(b);
  }
  std::size_t all(const Pose& b_in_a) override {
    return collide(a_->tree, b_->tree, b_in_a, pairs_, workspace_).pairs;
  }
  bool any(const Pose& b_in_a) override {
    return collide(a_->tree, b_->tree, b_in_a, pairs_, workspace_, {true}).intersecting;
  }
  void pairs(std::vector<Pair>& out) const override { out = pairs_; }

private:
  SharedModel a_;
  SharedModel b_;
  std::vector<Pair> pairs_;
  crashrank::CollideWorkspace workspace_;
};

}  // namespace

std::unique_ptr<Peer> make_crashrank() { return std::make_unique<Crashrank>(); }
std::unique_ptr<Peer> make_crashrank_scalar() { return std::make_unique<CrashrankScalar>(); }

}  // namespace peers
