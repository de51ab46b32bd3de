#include "peer.hpp"

#include <cstdio>

namespace peers {

std::vector<std::unique_ptr<Peer>> make_peers() {
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(make_crashrank_scalar());
  peers.push_back(make_crashrank());
#ifdef CRASHRANK_PEER_FCL
  peers.push_back(make_fcl());
#endif
#ifdef CRASHRANK_FCL_NATIVE
  std::string why_not;
  if (auto native = make_fcl_native(why_not)) {
    peers.push_back(std::move(native));
  } else {
    std::fprintf(stderr, "FCL native is left out: %s\n", why_not.c_str());
  }
#endif
#ifdef CRASHRANK_PEER_EMBREE
  peers.push_back(make_embree(true));
  peers.push_back(make_embree(false));
#endif
#ifdef CRASHRANK_PEER_BULLET
  peers.push_back(make_bullet());
#endif
#ifdef CRASHRANK_PEER_CGAL
  peers.push_back(make_cgal());
#endif
#ifdef CRASHRANK_PEER_ODE
  peers.push_back(make_ode());
#endif
  return peers;
}

}  // namespace peers
