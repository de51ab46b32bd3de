#pragma once

#include <algorithm>

namespace crashrank::detail {

/// A contact that begins less than `same_event_s` after the end of an earlier one of the same body
/// belongs to the same event, s. For one that begins later the earlier one still counts with a
/// share that falls linearly to 0 at `apart_s`: two hits in a row are not twice as harmful at 0.09
/// s as at 0.11 s.
inline constexpr double same_event_s = 0.1;
inline constexpr double apart_s = 0.2;

/// Share with which an earlier contact counts for one that begins `gap_s` after its end.
inline double shared_weight(double gap_s) {
  return std::clamp((apart_s - gap_s) / (apart_s - same_event_s), 0.0, 1.0);
}

/// Time in which the share of a force that counts falls from 1 to 0, s; see `CountedShare`.
inline constexpr double share_falls_s = 0.3;

/// Share of an impact that still counts at `time_s` if none does from `until_s` on.
inline double share_left(double until_s, double time_s) {
  return std::clamp((until_s - time_s) / share_falls_s, 0.0, 1.0);
}

}  // namespace crashrank::detail
