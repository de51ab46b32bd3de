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

/// Share with which an earlier impact, whose force had its mean at `force_s`, counts for one that
/// begins at `time_s`, if a weak force leads from one to the other: 1 up to 0.3 s later, 0 from 0.6
/// s on. The same times as those of `CountedShare`.
inline double share_left(double force_s, double time_s) {
  constexpr double whole_s = 0.3;
  constexpr double falls_s = 0.3;
  return std::clamp((force_s + whole_s + falls_s - time_s) / falls_s, 0.0, 1.0);
}

}  // namespace crashrank::detail
