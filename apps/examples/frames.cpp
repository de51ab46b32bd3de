// Poses from other programs' frames: CARLA's, an aircraft's, a camera's.
#include <crashrank/interop/frames.hpp>

#include <cstdio>

using namespace crashrank;

static void print(const char* what, const Eigen::Vector3d& v) {
  std::printf("%s %g %g %g\n", what, v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);  // + 0: no minus zero
}

int main() {
  // CARLA: metres and degrees, y to the right, yaw to the right.
  CarlaTransform carla;
  carla.x_m = 20.0;
  carla.y_m = 3.5;
  carla.yaw_deg = 180.0;
  const Pose oncoming = pose_from_carla(carla);
  print("oncoming car at", oncoming.translation);
  print("its velocity", flip_left_handed(Eigen::Vector3d(-14.0, 0.0, 0.0)));

  // Aircraft axes: x forward, y right, z down.
  print("obstacle at", flip_z_down(Eigen::Vector3d(12.0, 1.0, -0.5)));

  // A camera's optical frame: z into the picture, x right, y down.
  print("pedestrian at", from_optical(Eigen::Vector3d(-2.0, 0.3, 9.0)));
}
