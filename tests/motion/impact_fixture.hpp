#pragma once

#include "base/random.hpp"
#include "crashrank/collide/collide.hpp"
#include "crashrank/motion/time_of_impact.hpp"
#include "tree/shapes.hpp"

#include <gtest/gtest.h>

namespace crashrank::test {

constexpr double tolerance = 1e-4;

inline Motion moving(const Pose& start, const Eigen::Vector3d& v,
                     const Eigen::Vector3d& omega = {0, 0, 0}) {
  return FreeMotion{start, {v, omega}};
}

class TimeOfImpact : public testing::Test {
protected:
  Impact find(const AabbTree& a, const Motion& ma, const AabbTree& b, const Motion& mb, double from,
              double until, const ImpactOptions& options = {}) {
    return time_of_impact(a, ma, b, mb, from, until, workspace_, options);
  }
  ImpactWorkspace workspace_;
};

}  // namespace crashrank::test
