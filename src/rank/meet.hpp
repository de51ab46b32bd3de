#pragma once

#include "rank/contact_severity.hpp"
#include "rank/scene.hpp"

#include <cstddef>

namespace crashrank::detail {

/// ½·reduced mass·v²; the other's mass may be infinite. J.
double closing_energy_j(double ego_kg, double other_kg, double speed_mps);

/// A contact as the two bodies move when they meet; damage and severity are still to be told.
Contact make_contact(const Scene& scene, const EgoAtContact& ego, std::size_t actor,
                     const Impact& impact);

}  // namespace crashrank::detail
