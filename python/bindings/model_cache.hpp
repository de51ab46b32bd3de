#pragma once

#include "crashrank/scenario/scenario_models.hpp"

#include <cstddef>
#include <list>
#include <mutex>
#include <string>

namespace crashrank::python {

/// Models of files, kept for the scenarios that follow. A file that has changed since it was read
/// (its size, its time of change or its inode differ) is read again. Above the limit the models
/// used least recently are dropped; scenarios that use one keep it. Safe from any thread; one
/// thread at a time reads files.
class ModelCache {
public:
  /// Keeps models of so many triangles in all, and the last one read whatever its size.
  explicit ModelCache(std::size_t most_triangles) : most_triangles_(most_triangles) {}

  /// As `load_scenario_model`, with its errors as Failure. Errors are not kept.
  LoadedScenarioModel find(const ScenarioModel& wanted, const ScenarioModelOptions& how);

  /// Triangles of the models that are kept.
  std::size_t triangles() const;
  /// How many files were read so far.
  std::size_t loads() const;

private:
  struct Entry {
    std::string key;
    LoadedScenarioModel loaded;
  };

  void drop_oldest();

  mutable std::mutex mutex_;
  std::size_t most_triangles_;
  std::size_t triangles_ = 0;
  std::size_t loads_ = 0;
  std::list<Entry> entries_;  ///< most recently used first
};

}  // namespace crashrank::python
