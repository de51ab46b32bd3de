#pragma once

#include "crashrank/crashrank.h"

#include "crashrank/base/result.hpp"
#include "crashrank/scenario/harm_options.hpp"

namespace crashrank::c {

/// The options as C has them.
crashrank_harm to_c(const HarmOptions& options);

/// The options that C gives; what it has no member for is as in `otherwise`. Errors name the
/// member: usage for no value of an enumeration; bad_input for a number out of range.
Result<HarmOptions> from_c(const crashrank_harm& harm, const HarmOptions& otherwise);

/// Whether two options count alike.
bool same_harm(const HarmOptions& a, const HarmOptions& b);

}  // namespace crashrank::c
