#pragma once

#include "model.hpp"
#include "model_cache.hpp"

#include "crashrank/model/model.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <memory>
#include <mutex>
#include <string>
#include <tuple>
#include <vector>

namespace crashrank::python {

/// A scenario with its models, read when they are first needed and kept. Any number of threads may
/// share it.
class Situation {
public:
  /// `file`: as errors name it; empty for text. `cache`: where models of files are kept between
  /// scenarios; null: read for this one.
  Situation(Scenario scenario, std::vector<SharedBody> bodies, std::string file,
            std::shared_ptr<ModelCache> cache)
      : scenario_(std::move(scenario)),
        bodies_(std::move(bodies)),
        file_(std::move(file)),
        cache_(std::move(cache)) {}

  /// Reads the models that are not read yet. Not with the interpreter's lock: it may wait for
  /// another thread that reads them. Throws Failure.
  void load();

  /// As read; what model files state of the mass comes with `load`.
  const Scenario& scenario() const noexcept { return scenario_; }
  /// The scenario's file; empty for text.
  const std::string& file() const noexcept { return file_; }
  /// By model. After `load` only.
  const std::vector<Model>& models() const noexcept { return models_; }
  /// Of the meshes, each with its file. After `load` only.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }
  /// Names and paths of the models whose files are to be read, in the scenario's order.
  std::vector<std::tuple<std::string, std::string>> model_files() const;

private:
  std::mutex mutex_;
  bool loaded_ = false;
  Scenario scenario_;
  std::vector<SharedBody> bodies_;  ///< by model, null where its file is to be read
  std::string file_;
  std::shared_ptr<ModelCache> cache_;
  std::vector<Model> models_;
  std::vector<std::string> warnings_;
};

using SharedSituation = std::shared_ptr<Situation>;

}  // namespace crashrank::python
