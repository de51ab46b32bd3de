// Holds both engines of collide() against brute force in exact arithmetic on reduced meshes and on
// soups of adversarial triangles, and against FCL on full meshes, over random poses.

#include "crashrank/collide/collide.hpp"
#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/tree/build.hpp"
#include "oracle/body_poses.hpp"
#include "oracle/brute_force.hpp"
#include "oracle/fcl_pairs.hpp"
#include "oracle/shipped_models.hpp"
#include "oracle/triangle_soup.hpp"

#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

namespace {

using crashrank::Model;
using crashrank::Pair;
using crashrank::Pose;
using crashrank::TriangleMesh;

struct Body {
  std::string name;
  TriangleMesh mesh;
  std::vector<Model> models;  // one a way of building
  std::unique_ptr<oracle::FclMesh> fcl;
};

struct Options {
  std::uint64_t poses = 300;
  std::uint64_t seed = 1;
  std::string check = "brute";
  std::size_t triangles = 600;
  std::string folder;
  std::vector<std::string> models;
};

// What one engine got wrong, or FCL.
struct Errors {
  std::uint64_t missed = 0;
  std::uint64_t invented = 0;   // pairs that share no point, or given twice
  std::uint64_t any_wrong = 0;  // poses where "any" is not what the pairs say
  std::uint64_t sum() const { return missed + invented + any_wrong; }
};

std::vector<Pair> difference(const std::vector<Pair>& from, const std::vector<Pair>& what) {
  std::vector<Pair> rest;
  std::set_difference(from.begin(), from.end(), what.begin(), what.end(), std::back_inserter(rest));
  return rest;
}

const std::vector<crashrank::BuildOptions>& ways_of_building() {
  using crashrank::BoxFrame;
  using crashrank::SplitRule;
  static const std::vector<crashrank::BuildOptions> ways{
      {SplitRule::min_relative_segment, BoxFrame::world, 4},
      {SplitRule::min_relative_segment, BoxFrame::gaussian, 1},
      {SplitRule::paper, BoxFrame::world, 1},
      {SplitRule::sah, BoxFrame::gaussian, 8},
      {SplitRule::median, BoxFrame::world, 2}};
  return ways;
}

bool add_model(Body& body, const crashrank::BuildOptions& way) {
  auto model = make_model(body.mesh, way);
  if (!model) {
    std::fprintf(stderr, "%s: %s\n", body.name.c_str(), model.error().message().c_str());
    return false;
  }
  body.models.push_back(std::move(*model));
  return true;
}

class Campaign {
public:
  explicit Campaign(const Options& options) : options_(options), random_(options.seed) {}

  bool load() {
    if (options_.check == "soup") return true;
    for (const std::string& name : options_.models) {
      auto mesh = oracle::read_obj(options_.folder + "/" + name + ".obj");
      if (!mesh) {
        std::fprintf(stderr, "%s\n", mesh.error().message().c_str());
        return false;
      }
      Body body{name, std::move(*mesh), {}, nullptr};
      if (options_.check == "brute") {
        body.mesh = oracle::reduced_to(body.mesh, options_.triangles);
        for (const crashrank::BuildOptions& way : ways_of_building()) {
          if (!add_model(body, way)) return false;
        }
      } else {
        if (!add_model(body, {})) return false;
        body.fcl = std::make_unique<oracle::FclMesh>(body.mesh);
      }
      std::printf("%s: %zu triangles\n", name.c_str(), body.mesh.size());
      bodies_.push_back(std::move(body));
    }
    return true;
  }

  bool run() {
    const bool terminal = isatty(STDERR_FILENO) != 0;
    for (std::uint64_t n = 0; n < options_.poses; ++n) {
      if (!(options_.check == "soup" ? check_soup() : check_bodies())) return false;
      if (terminal && n % 20 == 0) {
        std::fprintf(stderr, "\r%5.1f %%",
                     100.0 * static_cast<double>(n) / static_cast<double>(options_.poses));
      }
    }
    if (terminal) std::fputs("\r        \r", stderr);
    return true;
  }

  bool report() const {
    std::printf(
        "%llu poses, %llu touching, %llu pairs\n", static_cast<unsigned long long>(options_.poses),
        static_cast<unsigned long long>(touching_), static_cast<unsigned long long>(pairs_));
    print("scalar engine", scalar_);
    print("vector engine", vector_);
    if (options_.check == "fcl") print("FCL", fcl_);
    if (touching_ == 0) std::puts("no pose touched: nothing was checked");
    return touching_ > 0 && scalar_.sum() + vector_.sum() == 0;
  }

private:
  static void print(const char* who, const Errors& errors) {
    std::printf("%-14s %llu missed, %llu invented, %llu wrong any\n", who,
                static_cast<unsigned long long>(errors.missed),
                static_cast<unsigned long long>(errors.invented),
                static_cast<unsigned long long>(errors.any_wrong));
  }

  std::size_t pick(std::size_t count) {
    return static_cast<std::size_t>(random_.integer(0, static_cast<std::int64_t>(count) - 1));
  }

  bool check_soup() {
    oracle::Soup soup = oracle::make_soup(random_, options_.triangles);
    Body a{"soup A", std::move(soup.a), {}, nullptr};
    Body b{"soup B", std::move(soup.b), {}, nullptr};
    const auto& ways = ways_of_building();
    if (!add_model(a, ways[pick(ways.size())]) || !add_model(b, ways[pick(ways.size())])) {
      return false;
    }
    check(a, a.models[0], b, b.models[0], soup.b_in_a);
    return true;
  }

  bool check_bodies() {
    const Body& a = bodies_[pick(bodies_.size())];
    const Body& b = bodies_[pick(bodies_.size())];
    const Model& model_a = a.models[pick(a.models.size())];
    const Model& model_b = b.models[pick(b.models.size())];
    check(a, model_a, b, model_b, oracle::random_pose(random_, a.mesh.bounds(), b.mesh.bounds()));
    return true;
  }

  void check(const Body& a, const Model& model_a, const Body& b, const Model& model_b,
             const Pose& pose) {
    std::vector<Pair> scalar;
    std::vector<Pair> vector;
    std::vector<Pair> one;
    collide(model_a.tree, model_b.tree, pose, scalar, scalar_workspace_);
    collide(model_a, model_b, pose, vector, vector_workspace_);
    const bool scalar_any =
        collide(model_a.tree, model_b.tree, pose, one, scalar_workspace_, {true}).intersecting;
    const bool vector_any =
        collide(model_a, model_b, pose, one, vector_workspace_, {true}).intersecting;
    std::sort(scalar.begin(), scalar.end());
    std::sort(vector.begin(), vector.end());

    std::vector<Pair> truth;
    if (a.fcl == nullptr) {
      truth = oracle::brute_force(a.mesh, b.mesh, pose);
    } else {
      // Where FCL and either engine part, exact arithmetic decides who is right.
      const std::vector<Pair> theirs = a.fcl->pairs(*b.fcl, pose);
      std::vector<Pair> claimed;
      std::set_union(scalar.begin(), scalar.end(), vector.begin(), vector.end(),
                     std::back_inserter(claimed));
      claimed.erase(std::unique(claimed.begin(), claimed.end()), claimed.end());
      std::set_intersection(claimed.begin(), claimed.end(), theirs.begin(), theirs.end(),
                            std::back_inserter(truth));
      for (const auto& doubtful : {difference(theirs, claimed), difference(claimed, theirs)}) {
        for (const Pair pair : doubtful) {
          if (oracle::shares_point(a.mesh, b.mesh, pose, pair)) truth.push_back(pair);
        }
      }
      std::sort(truth.begin(), truth.end());
      judge(fcl_, "FCL", a, b, theirs, truth, !theirs.empty());
    }
    judge(scalar_, "scalar", a, b, scalar, truth, scalar_any);
    judge(vector_, "vector", a, b, vector, truth, vector_any);
    pairs_ += truth.size();
    if (!truth.empty()) ++touching_;
  }

  void judge(Errors& errors, const char* who, const Body& a, const Body& b,
             const std::vector<Pair>& answer, const std::vector<Pair>& truth, bool any) {
    const std::uint64_t missed = difference(truth, answer).size();
    const std::uint64_t invented = difference(answer, truth).size();
    const bool any_wrong = any == answer.empty();
    errors.missed += missed;
    errors.invented += invented;
    errors.any_wrong += static_cast<std::uint64_t>(any_wrong);
    if (missed + invented > 0 || any_wrong) {
      std::fprintf(stderr, "%s, %s against %s: %llu missed, %llu invented%s\n", who, a.name.c_str(),
                   b.name.c_str(), static_cast<unsigned long long>(missed),
                   static_cast<unsigned long long>(invented), any_wrong ? ", any is wrong" : "");
    }
  }

  Options options_;
  oracle::Random random_;
  std::vector<Body> bodies_;
  crashrank::CollideWorkspace scalar_workspace_;
  crashrank::ModelWorkspace vector_workspace_;
  std::uint64_t pairs_ = 0;
  std::uint64_t touching_ = 0;
  Errors scalar_;
  Errors vector_;
  Errors fcl_;
};

}  // namespace

int main(int argc, char** argv) {
  Options options;
  options.folder = CRASHRANK_MODEL_FOLDER;
  options.models = {"hatch", "sedan", "truck", "motorcycle", "pedestrian", "jersey_barrier"};
  CLI::App app{"Holds crashrank's pair sets against brute force and FCL"};
  app.add_option("--poses", options.poses, "random poses; the nightly size is 10000");
  app.add_option("--seed", options.seed, "seed of the poses");
  app.add_option("--check", options.check,
                 "exact brute force on reduced models or adversarial soups, or FCL on models")
      ->check(CLI::IsMember({"brute", "soup", "fcl"}));
  app.add_option("--triangles", options.triangles, "size of reduced models and soups");
  app.add_option("--models", options.models, "names of shipped models")->delimiter(',');
  app.add_option("--folder", options.folder, "where the models' OBJ files are");
  CLI11_PARSE(app, argc, argv);

  std::printf("seed %llu\n", static_cast<unsigned long long>(options.seed));
  Campaign campaign(options);
  if (!campaign.load()) return 1;
  if (!campaign.run()) return 1;
  const bool right = campaign.report();
  std::printf("%.1f s of processor time\n",
              static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC));
  return right ? 0 : 1;
}
