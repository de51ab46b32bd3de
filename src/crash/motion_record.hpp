#pragma once

#include "crash/planar_body.hpp"
#include "crashrank/crash/contact_law.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace crashrank::detail {

/// Records where two bodies are while they press on each other, in constant memory: when it is full
/// every second entry is dropped and from then on every second step is left out.
class MotionRecord {
public:
  /// Starts anew with both bodies at first contact.
  void begin(const PlanarBody& first, const PlanarBody& second);
  /// Both bodies after a step with a force, `time_s` since first contact, rising.
  void add(double time_s, const PlanarBody& first, const PlanarBody& second);
  /// The bodies' poses; `first` and `second` as given at first contact. `swapped`: the first is B.
  ContactMotion motion(const ContactBody& first, const ContactBody& second, bool swapped) const;

private:
  struct Entry {
    double time_s = 0.0;
    PlanarPlace first;
    PlanarPlace second;
  };
  std::array<Entry, ContactMotion::most - 1>
      entries_;  ///< first contact, then every stride-th step
  Entry last_;
  std::size_t count_ = 0;
  std::uint32_t steps_ = 0;
  std::uint32_t stride_ = 1;
};

}  // namespace crashrank::detail
