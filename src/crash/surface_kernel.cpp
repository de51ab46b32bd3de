// Compile for SSE2, SSE4, AVX2 and AVX-512. The targets in between cost build time without a gain.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)

#include "crash/surface_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crash/surface_kernel.cpp"
#include <hwy/foreach_target.h>
// The code for each target has to follow foreach_target.h.
#include "crash/surface_kernel-inl.hpp"

#if HWY_ONCE

namespace crashrank::detail {

HWY_EXPORT(list_blocks);
HWY_EXPORT(accumulate_forces);

void list_blocks(const PressQuery& query, float near_m, NearPieces& near) {
  HWY_DYNAMIC_DISPATCH(list_blocks)(query, near_m, near);
}

void accumulate_forces(const PressQuery& query, NearPieces& near, PressTotals& totals,
                       PassSums& sums, PassRecord& record) {
  HWY_DYNAMIC_DISPATCH(accumulate_forces)(query, near, totals, sums, record);
}

}  // namespace crashrank::detail
#endif
