#include "peer.hpp"

#include <dlfcn.h>

namespace peers {

// Its symbols stay out of the program's: both builds of FCL are in one process, neither sees the
// other. The object is never unloaded, the peer's code lives in it.
std::unique_ptr<Peer> make_fcl_native(std::string& why_not) {
  void* object = dlopen(CRASHRANK_FCL_NATIVE, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
  if (object == nullptr) {
    why_not = dlerror();
    return nullptr;
  }
  using Make = Peer* (*)();
  const auto make = reinterpret_cast<Make>(dlsym(object, "crashrank_make_fcl_native"));
  if (make == nullptr) {
    why_not = dlerror();
    return nullptr;
  }
  return std::unique_ptr<Peer>(make());
}

}  // namespace peers
