// FCL with its users' flags: -O3 -march=native. Debian's headers declare the usual instantiations
// `extern`, so that they come from its generic library. With the word taken away they are made
// here. Fixed-size Eigen types are aligned differently under -march=native, so nothing of this
// object may be mixed with Debian's library: it is a shared object that shows one C function only,
// and what crosses that border (peer.hpp) holds no type whose layout follows the flags.

// Everything that needs its own `extern` comes before.
#include <ccd/ccd.h>
#include <ccd/quat.h>
#include <ccd/vec3.h>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <deque>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <queue>
#include <random>
#include <set>
#include <sstream>
#include <stack>
#include <string>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "peer.hpp"

#define extern
#include "fcl_peer.hpp"
#undef extern

extern "C" __attribute__((visibility("default"))) peers::Peer* crashrank_make_fcl_native() {
  return new peers::FclPeer("FCL OBBRSS native");
}
