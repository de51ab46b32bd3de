#include "model_cache.hpp"

#include "error.hpp"
#include "model.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

namespace crashrank::python {
namespace {

template <class T>
void share(Column<T>& column, const Column<T>& kept, const std::shared_ptr<const void>& keeper) {
  column = Column<T>::borrow(View<const T>(kept.data(), kept.size()), keeper);
}

void append_bytes(std::string& key, const void* data, std::size_t size) {
  key.append(static_cast<const char*>(data), size);
}

/// What a loaded model depends on; empty where the file cannot be examined.
std::string key_of(const ScenarioModel& wanted) {
  struct stat file {};
  if (wanted.path.empty() || ::stat(wanted.path.c_str(), &file) != 0) return {};
  std::string key = wanted.path;
  key.push_back('\0');
  append_bytes(key, &file.st_ino, sizeof file.st_ino);
  append_bytes(key, &file.st_size, sizeof file.st_size);
  append_bytes(key, &file.st_mtim.tv_sec, sizeof file.st_mtim.tv_sec);
  append_bytes(key, &file.st_mtim.tv_nsec, sizeof file.st_mtim.tv_nsec);
  const ImportTransform& transform = wanted.transform;
  append_bytes(key, &transform.scale, sizeof transform.scale);
  append_bytes(key, &transform.up, sizeof transform.up);
  append_bytes(key, &transform.forward, sizeof transform.forward);
  append_bytes(key, transform.origin_m.data(), 3 * sizeof(double));
  return key;
}

}  // namespace

Model shareable(Model model) {
  const auto kept = std::make_shared<const Model>(std::move(model));
  Model shared;
  shared.mesh.parts = kept->mesh.parts;
  share(shared.mesh.vertices, kept->mesh.vertices, kept);
  share(shared.mesh.triangles, kept->mesh.triangles, kept);
  shared.tree.axes = kept->tree.axes;
  shared.tree.axes_are_world = kept->tree.axes_are_world;
  shared.tree.depth = kept->tree.depth;
  share(shared.tree.nodes, kept->tree.nodes, kept);
  share(shared.tree.order, kept->tree.order, kept);
  share(shared.tree.triangles, kept->tree.triangles, kept);
  shared.wide.depth = kept->wide.depth;
  share(shared.wide.nodes, kept->wide.nodes, kept);
  share(shared.wide.clusters, kept->wide.clusters, kept);
  share(shared.wide.lanes_of, kept->wide.lanes_of, kept);
  shared.profile = kept->profile;
  return shared;
}

LoadedScenarioModel ModelCache::find(const ScenarioModel& wanted, const ScenarioModelOptions& how) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string key = key_of(wanted);
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.key == key; });
  if (!key.empty() && found != entries_.end()) {
    check(check_model_mass(found->loaded, wanted));
    entries_.splice(entries_.begin(), entries_, found);
    return entries_.front().loaded;
  }
  LoadedScenarioModel loaded = value_of(load_scenario_model(wanted, how));
  ++loads_;
  if (key.empty()) return loaded;
  loaded.model = shareable(std::move(loaded.model));
  triangles_ += loaded.model.mesh.size();
  entries_.push_front({key, std::move(loaded)});
  drop_oldest();
  return entries_.front().loaded;
}

void ModelCache::drop_oldest() {
  while (triangles_ > most_triangles_ && entries_.size() > 1) {
    triangles_ -= entries_.back().loaded.model.mesh.size();
    entries_.pop_back();
  }
}

std::size_t ModelCache::triangles() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return triangles_;
}

std::size_t ModelCache::loads() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return loads_;
}

}  // namespace crashrank::python
