#pragma once

#include "crashrank/mesh/import.hpp"

#include <cstddef>
#include <functional>

namespace crashrank::detail {

enum class Reply {
  complete,    ///< `imported` holds a mesh whose indices, parts and numbers are in order
  refused,     ///< `failure` says why the importer would not have the file
  broken_off,  ///< the importer ended, or ran out of time, before it had answered
};

/// Fetches exactly so many bytes of an answer, or returns false.
using ReadBytes = std::function<bool(void* data, std::size_t size)>;

/// Reads the importer's reply and checks all of it before use: a parser that a file has taken
/// over can write anything. Counts are held against the limits before memory is asked for.
Reply read_reply(const ReadBytes& read, const ImportLimits& limits, ImportedMesh& imported,
                 Error& failure);

}  // namespace crashrank::detail
