#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/scenario/harm_options.hpp"

#include <string>

namespace crashrank {

/// Reads a profile: whose harm counts for how much, who is where, which risk model, and the ranges
/// of what is not known. The format is data/profile.schema.json. What the profile leaves out stays
/// as in `otherwise`, so that a profile can be laid over a scenario's own. Text from a stranger:
/// every error is bad_input or limit_exceeded and names the file and the key path, as
/// "weights.pedestrian", or line and column where the text is no JSON. `file` only names it.
CRASHRANK_API Result<HarmOptions> parse_profile(const std::string& text, const std::string& file,
                                                const HarmOptions& otherwise = {});

/// Reads the file, at most `harm_limits::file_bytes`. Errors also: not_found.
CRASHRANK_API Result<HarmOptions> load_profile_file(const std::string& file,
                                                    const HarmOptions& otherwise = {});

}  // namespace crashrank
