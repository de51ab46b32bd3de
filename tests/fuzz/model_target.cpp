// Model files: whatever the bytes, loading them either says what is wrong or gives a model whose
// queries are right, on both engines, whose profile is sound, and which is written again as the
// same bytes.

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/tree/build.hpp"
#include "fuzz/target.hpp"
#include "model/model_layout.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <memory>
#include <string>

namespace fuzz {
namespace {

using namespace crashrank;

TriangleMesh soup(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto coordinate = [&] {
    return static_cast<float>(static_cast<double>(random() >> 40U) / double{1U << 24U} * 2.0 - 1.0);
  };
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Eigen::Vector3f at(2.0F * coordinate(), coordinate(), coordinate());
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.emplace_back(at +
                                 0.3F * Eigen::Vector3f(coordinate(), coordinate(), coordinate()));
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const auto half = static_cast<std::uint32_t>(count / 2);
  if (half > 0) mesh.parts.push_back({"door", 0, half});
  mesh.parts.push_back(
      {"h\xc3\xa9misph\xc3\xa8re", half, static_cast<std::uint32_t>(count) - half});
  return mesh;
}

Bytes encoded(std::size_t count, const BuildOptions& options) {
  TriangleMesh mesh = soup(count, count);
  if (count == 2) {  // so far up that nothing presses on it
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex.z() += 10.0F;
  }
  StoredModel stored;
  stored.mass = shell_properties(mesh);
  Result<Model> model = make_model(std::move(mesh), options);
  require(model.ok(), "a seed cannot be built");
  const Box bounds = model->mesh.bounds();
  constexpr double mass_kg = 12.0;
  const double block = bounds.extent().cast<double>().head<2>().squaredNorm() / 12.0;
  stored.stated = {mass_kg, bounds.center().cast<double>(), mass_kg * block};
  stored.model = std::move(*model);
  const Result<std::vector<unsigned char>> bytes = encode_model(stored);
  require(bytes.ok(), "a seed cannot be encoded");
  return Bytes(bytes->begin(), bytes->end());
}

std::vector<Pair> sorted(std::vector<Pair> pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<Pair> brute_force(const TriangleMesh& mesh, const Pose& pose) {
  std::vector<Pair> pairs;
  std::uint64_t exact = 0;
  for (std::size_t j = 0; j < mesh.size(); ++j) {
    const TriangleD b = carry(pose, mesh.triangle(j));
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      if (triangles_intersect(to_double(mesh.triangle(i)), b, exact)) {
        pairs.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)});
      }
    }
  }
  return sorted(std::move(pairs));
}

void query(const Model& model) {
  ModelWorkspace workspace;
  std::vector<Pair> pairs;
  for (int i = 0; i < 2; ++i) {
    const Pose pose = pose_from_angles({0.4 * i, 0.1, -0.2 * i}, 0.3 + i, 0.2 * i, 0.1);
    const std::vector<Pair> expected = brute_force(model.mesh, pose);
    collide(model, model, pose, pairs, workspace);
    require(sorted(pairs) == expected, "the vector engine finds other pairs");
    collide(model.tree, model.tree, pose, pairs, workspace.scalar);
    require(sorted(pairs) == expected, "the scalar engine finds other pairs");
    // What lies below the nodes of one tree, against all of the other.
    if (model.tree.nodes.size() < 3) continue;
    std::vector<Pair> together;
    std::vector<std::uint32_t> nodes{1, 2};
    if (!model.tree.nodes[1].is_leaf()) {
      nodes = {model.tree.nodes[1].first, model.tree.nodes[1].first + 1, 2};
    }
    for (const std::uint32_t node : nodes) {
      collide(model, node, model, 0, pose, pairs, workspace);
      together.insert(together.end(), pairs.begin(), pairs.end());
    }
    require(sorted(together) == expected, "the nodes below the root find other pairs");
  }
}

}  // namespace

std::vector<Bytes> seeds() {
  std::vector<Bytes> made;
  for (const std::size_t count : {1U, 2U, 7U, 9U, 30U, 70U}) {
    for (const BoxFrame frame : {BoxFrame::world, BoxFrame::gaussian}) {
      BuildOptions options;
      options.frame = frame;
      options.leaf_size = count == 30 ? 12 : 4;  // 12: leaves too large for a wide tree
      options.fill_leaves = count == 30;
      made.push_back(encoded(count, options));
    }
  }
  const auto without_profile = [](const Bytes& bytes) {
    detail::ModelHeader header{};
    std::memcpy(&header, bytes.data(), sizeof header);
    return header.first_piece.back() == 0;
  };
  const auto without = std::count_if(made.begin(), made.end(), without_profile);
  require(without > 0 && without < static_cast<std::ptrdiff_t>(made.size()),
          "the seeds are all with or all without a profile");
  return made;
}

void mutate(Bytes& bytes, std::mt19937_64& random) {
  if (bytes.size() < sizeof(detail::ModelHeader) || random() % 16 == 0) {
    mutate_bytes(bytes, random);
    return;
  }
  detail::ModelHeader header{};
  std::memcpy(&header, bytes.data(), sizeof header);
  const detail::ModelLayout layout = detail::layout_of(header);
  // A word of the head or of one section becomes another: one that means something, a neighbour's,
  // or nearly what it was.
  std::size_t from = 0;
  std::size_t size = sizeof header;
  if (random() % 8 != 0 && layout.end <= bytes.size()) {
    const detail::SectionPlace& place =
        layout.section[below(random, std::size_t{detail::section_count})];
    if (place.bytes >= 4) {
      from = place.offset;
      size = place.bytes;
    }
  }
  const std::size_t at = from + below(random, size / 4) * 4;
  const std::size_t other = from + below(random, size / 4) * 4;
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  constexpr std::uint32_t telling[] = {0,           1,           0xffffffffU, 0x80000000U,
                                       0x7fffffffU, 0x7f800000U, 0xff800000U, 0x7fc00000U,
                                       0x7f7fffffU, 0x00000001U, 0xf149f2caU, 2,
                                       8,           0xffU,       0x100U};
  switch (random() % 6) {
    case 0:
      word = telling[below(random, std::size(telling))];
      break;
    case 1:
      word += random() % 2 == 0 ? 1U : ~0U;
      break;
    case 2:
      word ^= 1U << random() % 32;
      break;
    case 3:
      word = static_cast<std::uint32_t>(random() % 64);
      break;
    case 4:
      std::memcpy(&word, bytes.data() + other, sizeof word);
      break;
    default: {
      std::uint32_t there = 0;
      std::memcpy(&there, bytes.data() + other, sizeof there);
      std::memcpy(bytes.data() + other, &word, sizeof word);
      word = there;
      break;
    }
  }
  std::memcpy(bytes.data() + at, &word, sizeof word);
}

bool take(const Bytes& bytes) {
  if (bytes.size() > std::size_t{1} << 18U) return false;
  void* memory = nullptr;
  require(posix_memalign(&memory, 64, std::max<std::size_t>(bytes.size(), 1)) == 0, "no memory");
  const std::shared_ptr<const void> keeper(memory,
                                           [](const void* m) { std::free(const_cast<void*>(m)); });
  std::copy(bytes.begin(), bytes.end(), static_cast<std::uint8_t*>(memory));
  const View<const unsigned char> view(static_cast<const unsigned char*>(memory), bytes.size());
  // The checksum would keep nearly every mutation from what lies behind it.
  const Result<LoadedModel> loaded = detail::decode_model(view, keeper, false);
  if (!loaded) {
    require(!loaded.error().reason.empty() && !loaded.error().remedy.empty(),
            "an error says nothing");
    return false;
  }
  const StoredModel& stored = loaded->stored;
  const Profile* const profile = stored.model.profile.get();
  require(profile == nullptr ||
              (profile->pieces.size() == profile->first.back() && profile->volume_m3() >= 0.0),
          "a profile is unsound");
  const Result<std::vector<unsigned char>> again = encode_model(stored);
  require(again.ok() && again->size() == bytes.size(), "what loads cannot be written");
  Bytes first = bytes;
  std::memcpy(first.data() + offsetof(detail::ModelHeader, checksum),
              again->data() + offsetof(detail::ModelHeader, checksum), sizeof(std::uint32_t));
  require(std::equal(first.begin(), first.end(), again->begin()), "it is written as other bytes");
  if (stored.model.mesh.size() <= 100) query(stored.model);
  return true;
}

}  // namespace fuzz
