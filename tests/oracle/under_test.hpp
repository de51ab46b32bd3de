#pragma once

#include "oracle/box_checks.hpp"
#include "oracle/triangle_oracle.hpp"

namespace oracle {

/// The library's tests as the headers have them; triangle_under_test.cpp and box_under_test.cpp
/// are compiled again with the headers of each planted fault.
bool library_triangle_test(const Triangle& a, const Triangle& b);
std::array<BoxCheck, box_check_count> library_box_test(const BoxCheckOptions& options);

}  // namespace oracle
