// Four vector units span what matters: SSE2, SSE4, AVX2, AVX-512. Those between only cost build
// time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)

#include "crash/surface_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crash/surface_kernel.cpp"
#include <hwy/foreach_target.h>
// The per-target code comes after foreach_target.
#include "crash/surface_kernel-inl.hpp"

#if HWY_ONCE

namespace crashrank::detail {

HWY_EXPORT(list_blocks);
HWY_EXPORT(press_blocks);

void list_blocks(const PressQuery& query, float near_m, NearPieces& near) {
  HWY_DYNAMIC_DISPATCH(list_blocks)(query, near_m, near);
}

void press_blocks(const PressQuery& query, NearPieces& near, PressTotals& totals, PassSums& sums,
                  PassRecord& record) {
  HWY_DYNAMIC_DISPATCH(press_blocks)(query, near, totals, sums, record);
}

}  // namespace crashrank::detail
#endif
