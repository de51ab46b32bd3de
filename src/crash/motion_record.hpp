#pragma once

#include "crash/planar_body.hpp"
#include "crashrank/crash/contact_law.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace crashrank::detail {

/// Records the poses of two bodies during a contact in constant memory. When the memory is full, it
/// drops every second entry and from then on records half as often.
class MotionRecord {
public:
  /// Restarts the record with both bodies at first contact.
  void begin(const PlanarBody& first, const PlanarBody& second);
  /// Adds both bodies after a step with a force; `time_s` since first contact has to rise.
  void add(double time_s, const PlanarBody& first, const PlanarBody& second);
  /// Returns the recorded poses; `first` and `second` as given at first contact. `swapped`: the
  /// first body is B.
  ContactMotion motion(const ContactBody& first, const ContactBody& second, bool swapped) const;

private:
  struct Entry {
    double time_s = 0.0;
    PlanarPlace first;
    PlanarPlace second;
  };
  /// First contact, then every `stride_`-th step.
  std::array<Entry, ContactMotion::most - 1> entries_;
  Entry last_;
  std::size_t count_ = 0;
  std::uint32_t steps_ = 0;
  std::uint32_t stride_ = 1;
};

}  // namespace crashrank::detail
