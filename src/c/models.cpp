#include "c/handles.hpp"

#include "crashrank/collide/body_state.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <utility>

namespace {

using namespace crashrank;
using c::guarded;
using c::refuse;
using c::refuse_null;

Result<std::vector<Part>> to_parts(const crashrank_part* parts, std::size_t count,
                                   std::size_t triangles) {
  if (count == 0) return std::vector<Part>{{"body", 0, static_cast<std::uint32_t>(triangles)}};
  std::vector<Part> made;
  std::set<std::string> names;
  std::size_t first = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (parts[i].name == nullptr || !names.insert(parts[i].name).second) {
      return make_error(ErrorCode::bad_input,
                        "part " + std::to_string(i) + " has no name or that of another part");
    }
    if (parts[i].triangle_count > triangles - first) break;
    made.push_back({parts[i].name, static_cast<std::uint32_t>(first), parts[i].triangle_count});
    first += parts[i].triangle_count;
  }
  if (made.size() != count || first != triangles) {
    return make_error(ErrorCode::bad_input, "the parts do not cover the triangles",
                      "let their triangle_count add up to the number of triangles");
  }
  return made;
}

bool has(const crashrank_models* models, std::size_t index) {
  return models != nullptr && index < models->list.size();
}

/// The pairs of a query, left in its buffer.
crashrank_status ask(crashrank_query* query, const crashrank_models* models, std::size_t a,
                     std::size_t b, const double* b_in_a, bool any, crashrank_error* error) {
  if (const char* null =
          c::first_null({{"query", query}, {"models", models}, {"b_in_a", b_in_a}})) {
    return refuse_null(null, error);
  }
  if (!has(models, a) || !has(models, b)) {
    return refuse(CRASHRANK_USAGE, "there is no model with that index", error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Result<Pose> pose = c::to_pose(b_in_a, "b_in_a");
    if (!pose) return refuse(pose.error(), error);
    CollideOptions options;
    options.any = any;
    query->workspace.prepare(models->list[a], models->list[b]);
    collide(models->list[a], models->list[b], *pose, query->pairs, query->workspace, options);
    return CRASHRANK_OK;
  });
}

}  // namespace

crashrank_status crashrank_models_create(crashrank_models** models, crashrank_error* error) {
  if (models == nullptr) return refuse_null("models", error);
  return guarded(error, [&]() -> crashrank_status {
    *models = new crashrank_models;
    return CRASHRANK_OK;
  });
}

void crashrank_models_free(crashrank_models* models) { delete models; }

crashrank_status crashrank_models_add(crashrank_models* models, const float* vertices_m,
                                      size_t vertex_count, const uint32_t* triangles,
                                      size_t triangle_count, const crashrank_part* parts,
                                      size_t part_count, crashrank_error* error) {
  if (const char* null = c::first_null(
          {{"models", models}, {"vertices_m", vertices_m}, {"triangles", triangles}})) {
    return refuse_null(null, error);
  }
  if (parts == nullptr && part_count > 0) return refuse_null("parts", error);
  return guarded(error, [&]() -> crashrank_status {
    if (triangle_count > max_triangles || vertex_count > 3 * max_triangles) {
      return refuse(CRASHRANK_LIMIT_EXCEEDED, "a model has at most 2147483647 triangles", error);
    }
    Result<std::vector<Part>> made = to_parts(parts, part_count, triangle_count);
    if (!made) return refuse(made.error(), error);
    TriangleMesh mesh;
    mesh.parts = std::move(*made);
    mesh.vertices.resize(vertex_count);
    for (std::size_t i = 0; i < vertex_count; ++i) {
      mesh.vertices[i] = {vertices_m[3 * i], vertices_m[3 * i + 1], vertices_m[3 * i + 2]};
    }
    mesh.triangles.resize(triangle_count);
    for (std::size_t i = 0; i < triangle_count; ++i) {
      mesh.triangles[i] = {triangles[3 * i], triangles[3 * i + 1], triangles[3 * i + 2]};
    }
    Result<Model> model = make_model(std::move(mesh));
    if (!model) return refuse(model.error(), error);
    models->add(std::move(*model));
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_models_load(crashrank_models* models, const char* file,
                                       crashrank_error* error) {
  if (const char* null = c::first_null({{"models", models}, {"file", file}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    Result<LoadedModel> loaded = load_model(file);
    if (!loaded) return refuse(loaded.error(), error);
    models->add(std::move(loaded->stored.model), loaded->stored.stated);
    return CRASHRANK_OK;
  });
}

size_t crashrank_models_size(const crashrank_models* models) {
  return models == nullptr ? 0 : models->list.size();
}

size_t crashrank_models_triangles(const crashrank_models* models, size_t index) {
  return has(models, index) ? models->list[index].mesh.size() : 0;
}

size_t crashrank_models_parts(const crashrank_models* models, size_t index) {
  return has(models, index) ? models->list[index].mesh.parts.size() : 0;
}

const char* crashrank_models_part_name(const crashrank_models* models, size_t index, size_t part) {
  if (part >= crashrank_models_parts(models, index)) return nullptr;
  return models->list[index].mesh.parts[part].name.c_str();
}

crashrank_status crashrank_query_create(crashrank_query** query, crashrank_error* error) {
  if (query == nullptr) return refuse_null("query", error);
  return guarded(error, [&]() -> crashrank_status {
    *query = new crashrank_query;
    return CRASHRANK_OK;
  });
}

void crashrank_query_free(crashrank_query* query) { delete query; }

crashrank_status crashrank_collide_any(crashrank_query* query, const crashrank_models* models,
                                       size_t a, size_t b, const double b_in_a[16],
                                       int32_t* intersecting, crashrank_error* error) {
  if (intersecting == nullptr) return refuse_null("intersecting", error);
  const crashrank_status status = ask(query, models, a, b, b_in_a, true, error);
  if (status == CRASHRANK_OK) *intersecting = query->pairs.empty() ? 0 : 1;
  return status;
}

crashrank_status crashrank_collide_state(crashrank_query* query, const crashrank_models* models,
                                         size_t a, size_t b, const double b_in_a[16],
                                         crashrank_body_state* state, crashrank_error* error) {
  if (state == nullptr) return refuse_null("state", error);
  const crashrank_status status = ask(query, models, a, b, b_in_a, true, error);
  if (status != CRASHRANK_OK) return status;
  return guarded(error, [&]() -> crashrank_status {
    CollideResult result;
    result.intersecting = !query->pairs.empty();
    const Model& first = models->list[a];
    const Model& second = models->list[b];
    const Result<Pose> pose = c::to_pose(b_in_a, "b_in_a");
    if (!pose) return refuse(pose.error(), error);
    const bool near =
        !result.intersecting && boxes_may_touch(first.tree.nodes[0].box, second.tree.nodes[0].box,
                                                box_transform(first.tree, second.tree, *pose));
    const Solid none;
    const Solid& first_solid = near ? models->solids[a]->of(first) : none;
    const Solid& second_solid = near ? models->solids[b]->of(second) : none;
    *state = static_cast<crashrank_body_state>(
        body_state(first, first_solid, second, second_solid, *pose, result));
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_collide_all(crashrank_query* query, const crashrank_models* models,
                                       size_t a, size_t b, const double b_in_a[16],
                                       const crashrank_pair** pairs, size_t* count,
                                       crashrank_error* error) {
  if (const char* null = c::first_null({{"pairs", pairs}, {"count", count}})) {
    return refuse_null(null, error);
  }
  const crashrank_status status = ask(query, models, a, b, b_in_a, false, error);
  if (status != CRASHRANK_OK) return status;
  return guarded(error, [&]() -> crashrank_status {
    std::sort(query->pairs.begin(), query->pairs.end());
    query->pairs_for_caller.clear();
    for (const Pair& pair : query->pairs) query->pairs_for_caller.push_back({pair.a, pair.b});
    *pairs = query->pairs_for_caller.data();
    *count = query->pairs_for_caller.size();
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_pairs_hash(const crashrank_pair* pairs, size_t count, char hash[17],
                                      crashrank_error* error) {
  if (hash == nullptr) return refuse_null("hash", error);
  if (pairs == nullptr && count > 0) return refuse_null("pairs", error);
  return guarded(error, [&]() -> crashrank_status {
    std::vector<Pair> list(count);
    for (std::size_t i = 0; i < count; ++i) list[i] = {pairs[i].a, pairs[i].b};
    const std::string text = pairs_hash(list);
    std::memcpy(hash, text.c_str(), 17);
    return CRASHRANK_OK;
  });
}
