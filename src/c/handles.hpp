#pragma once

#include "crashrank/crashrank.h"

#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/collide/body_state.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/internal/report/escape.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <utility>
#include <vector>

// What the C interface's names stand for. Both libraries include this: it is compiled into each.

/// The surfaces of a model, found when they are first needed. Safe from any thread.
class LazySolid {
public:
  const crashrank::Solid& of(const crashrank::Model& model) {
    std::call_once(once_, [&] { solid_ = crashrank::make_solid(model.mesh); });
    return solid_;
  }

private:
  std::once_flag once_;
  crashrank::Solid solid_;
};

struct crashrank_models {
  std::vector<crashrank::Model> list;
  std::vector<std::unique_ptr<LazySolid>> solids;  ///< by model
  std::vector<crashrank::StatedMass> stated;       ///< by model, in its file

  void add(crashrank::Model model, const crashrank::StatedMass& of_file = {}) {
    stated.reserve(list.size() + 1);
    solids.reserve(list.size() + 1);
    auto solid = std::make_unique<LazySolid>();
    list.push_back(std::move(model));
    stated.push_back(of_file);
    solids.push_back(std::move(solid));
  }
};

struct crashrank_query {
  crashrank::ModelWorkspace workspace;
  std::vector<crashrank::Pair> pairs;
  std::vector<crashrank_pair> pairs_for_caller;  ///< the same, in the caller's type
};

struct crashrank_scenario {
  crashrank::Scenario scenario;
};

struct crashrank_ranking {
  crashrank::RankResult result;
  std::vector<std::string> actors;
  std::string json;
};

namespace crashrank::c {

inline crashrank_status status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
      return CRASHRANK_USAGE;
    case ErrorCode::bad_input:
      return CRASHRANK_BAD_INPUT;
    case ErrorCode::not_found:
      return CRASHRANK_NOT_FOUND;
    case ErrorCode::limit_exceeded:
      return CRASHRANK_LIMIT_EXCEEDED;
    case ErrorCode::out_of_budget:
      return CRASHRANK_OUT_OF_BUDGET;
    case ErrorCode::out_of_memory:
      return CRASHRANK_OUT_OF_MEMORY;
    default:
      return CRASHRANK_INTERNAL;
  }
}

/// Reports an error to the caller; allocates nothing, so that it can report lost memory.
inline crashrank_status refuse(crashrank_status status, const char* message,
                               crashrank_error* error) noexcept {
  if (error == nullptr) return status;
  error->status = status;
  std::size_t length = std::min(std::strlen(message), sizeof error->message - 1);
  // A character is not cut in half: its later bytes are 10xxxxxx.
  if (message[length] != '\0') {
    while (length > 0 && (static_cast<unsigned char>(message[length]) & 0xC0U) == 0x80U) --length;
  }
  std::memcpy(error->message, message, length);
  error->message[length] = '\0';
  return status;
}

/// The same for the library's errors.
inline crashrank_status refuse(const Error& why, crashrank_error* error) {
  return refuse(status_of(why.code), escape_terminal(why.message()).c_str(), error);
}

/// An argument or member that has to be given, and its name.
struct Required {
  const char* name;
  const void* given;
};

/// The name of the first that is NULL; NULL if all are given.
inline const char* first_null(std::initializer_list<Required> all) noexcept {
  for (const Required& one : all) {
    if (one.given == nullptr) return one.name;
  }
  return nullptr;
}

/// Refuses an argument or member of that name because it is NULL. Allocates nothing.
inline crashrank_status refuse_null(const char* name, crashrank_error* error) noexcept {
  char message[128];
  std::snprintf(message, sizeof message, "%s: is NULL; it has to be given", name);
  return refuse(CRASHRANK_USAGE, message, error);
}

/// Runs a function that answers a status; nothing that it throws gets out.
template <class Function>
crashrank_status guarded(crashrank_error* error, const Function& function) noexcept {
  try {
    return function();
  } catch (const std::bad_alloc&) {
    return refuse(CRASHRANK_OUT_OF_MEMORY, "there is not enough memory", error);
  } catch (const std::exception& problem) {
    return refuse(CRASHRANK_INTERNAL, problem.what(), error);
  } catch (...) {
    return refuse(CRASHRANK_INTERNAL, "an unknown failure; report this as a defect", error);
  }
}

/// The scenario, with what model files state of the masses of its shapes.
inline Scenario with_stated_masses(const crashrank_scenario& scenario,
                                   const crashrank_models& models) {
  Scenario made = scenario.scenario;
  for (std::size_t i = 0; i < std::min(made.models.size(), models.stated.size()); ++i) {
    add_stated_mass(models.stated[i], made.models[i]);
  }
  return made;
}

/// A pose from its 16 numbers. Errors: bad_input naming the argument or member.
inline Result<Pose> to_pose(const double* row_major, const std::string& member) {
  Result<Pose> pose = pose_from_matrix(View<const double>(row_major, 16));
  if (!pose) pose.error().place = member;
  return pose;
}

}  // namespace crashrank::c
