#include "crashrank/crash/pulse.hpp"

#include "crash/pulse_run.hpp"

#include "crashrank/crash/depth_map.hpp"

#include <limits>
#include <vector>

namespace crashrank {

using Eigen::Vector3d;

std::vector<PulseResult> simulate_pulses(const PulseBody& a, const PulseBody& b,
                                         const Vector3d& point_m, const Vector3d& along,
                                         View<const PulseVariant> variants,
                                         const PulseOptions& options) {
  std::vector<PulseResult> results(variants.size());
  if (!detail::can_press(a, b, along)) return results;
  const ViewFrame frame = view_along(along, point_m);
  detail::PulseMemory memory;
  detail::look(a, b, frame, options, memory);
  for (std::size_t i = 0; i < variants.size(); ++i) {
    detail::PulseRun run(a, b, frame, variants[i], options, memory);
    run.advance(std::numeric_limits<int>::max());
    results[i] = run.result();
  }
  return results;
}

PulseResult simulate_pulse(const PulseBody& a, const PulseBody& b, const Vector3d& point_m,
                           const Vector3d& along, const PulseOptions& options) {
  const PulseVariant given{options.friction, 1.0};
  return simulate_pulses(a, b, point_m, along, {&given, 1}, options).front();
}

}  // namespace crashrank
