#include "common.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

// dispatch_bench COMMAND A B POSES: measurements of the dispatch on two meshes and a file of poses
// (one row-major 4x4 matrix of B in A a line). Commands: estimates, goals, overhead,
// plan, validate.
// dispatch_bench poses A B COUNT SEED: prints such poses, front into side, 5 to 30 cm deep.
int main(int argc, char** argv) {
  using namespace crashrank::bench;
  struct Command {
    const char* name;
    void (*run)(const Scene& scene);
  };
  constexpr Command commands[] = {{"estimates", estimates},
                                  {"goals", goals},
                                  {"overhead", overhead},
                                  {"plan", plan},
                                  {"validate", validate}};
  if (argc == 6 && std::strcmp(argv[1], "poses") == 0) {
    print_poses(load_model(argv[2]), load_model(argv[3]),
                static_cast<int>(std::strtol(argv[4], nullptr, 10)),
                std::strtoull(argv[5], nullptr, 10));
    return 0;
  }
  for (const Command& command : commands) {
    if (argc != 5 || std::strcmp(argv[1], command.name) != 0) continue;
    Scene scene;
    load(scene, argv[2], argv[3], argv[4]);
    command.run(scene);
    return 0;
  }
  std::fprintf(stderr,
               "usage: dispatch_bench estimates|goals|overhead|plan|validate A B POSES\n"
               "       dispatch_bench poses A B COUNT SEED\n");
  return 2;
}
