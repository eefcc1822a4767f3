// SPDX-License-Identifier: Apache-2.0
// Stands in for the peers whose Debian packages are not installed.
#include "peers/peer.h"

namespace frontmost::bench {

#ifndef FRONTMOST_BENCH_LLVMPIPE
std::unique_ptr<RasterPeer> make_llvmpipe(const PeerInput&) { return nullptr; }
std::unique_ptr<PeelingPeer> make_peeling(const PeerInput&) { return nullptr; }
#endif
#ifndef FRONTMOST_BENCH_EMBREE
std::unique_ptr<RayPeer> make_embree(const PeerInput&) { return nullptr; }
#endif

}  // namespace frontmost::bench
