#include "fcl_peer.hpp"

namespace peers {

std::unique_ptr<Peer> make_fcl() { return std::make_unique<FclPeer>("FCL OBBRSS"); }

}  // namespace peers
