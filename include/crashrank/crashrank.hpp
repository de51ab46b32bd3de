#pragma once

/// Everything that the targets crashrank::core and crashrank::crashrank offer. Mesh files are read
/// by crashrank::import, whose headers are crashrank/mesh/import.hpp and
/// crashrank/scenario/scenario_models.hpp.

#include "crashrank/base/library_version.hpp"
#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/version.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/interop/frames.hpp"

#include "crashrank/mesh/quality.hpp"
#include "crashrank/mesh/shell_properties.hpp"
#include "crashrank/mesh/stated_mass.hpp"
#include "crashrank/mesh/transform.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model_file.hpp"
#include "crashrank/tree/build.hpp"
#include "crashrank/tree/model.hpp"
#include "crashrank/tree/validate.hpp"
#include "crashrank/tree/validate_wide.hpp"

#include "crashrank/collide/broad_phase.hpp"
#include "crashrank/collide/collide.hpp"
#include "crashrank/collide/distance.hpp"
#include "crashrank/collide/pair_hash.hpp"
#include "crashrank/collide/pair_kind.hpp"
#include "crashrank/collide/wide_collide.hpp"

#include "crashrank/dispatch/dispatcher.hpp"

#include "crashrank/vehicle/body_kind.hpp"
#include "crashrank/vehicle/surface.hpp"

#include "crashrank/crash/cdc.hpp"
#include "crashrank/crash/contact_law.hpp"
#include "crashrank/crash/injury.hpp"
#include "crashrank/crash/pdof.hpp"
#include "crashrank/motion/motion.hpp"
#include "crashrank/motion/time_of_impact.hpp"

#include "crashrank/rank/anytime/ranker.hpp"
#include "crashrank/rank/harm.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/profile.hpp"
#include "crashrank/scenario/scenario.hpp"

#include "crashrank/report/damage_model.hpp"
#include "crashrank/report/html_report.hpp"
#include "crashrank/report/picture.hpp"
#include "crashrank/report/ranking.hpp"
