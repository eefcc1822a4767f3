// SPDX-License-Identifier: Apache-2.0
// Peers in processes of their own, as their users run them.
//
// In our process llvmpipe would be 1.2 to 1.4 times faster than in its own: it gives its memory back after every frame
// and takes it again for the next, and where other blocks lie above it, glibc cannot hand it to the system in between.
// `keeps_memory` turns that handing back off, so that both figures can be told.
#pragma once

#include <cstdio>
#include <string>

#include "harness/program.h"

namespace frontmost::bench {

struct PeerRequest {
  std::string peer;  ///< "llvmpipe", "peeling" or "embree"
  std::string scene;
  int threads = 1;
  bool keeps_memory = false;
};

/// A process that draws one scene with one peer whenever it is asked.
class PeerProcess {
 public:
  /// \throws Error unsupported when it does not start.
  PeerProcess(const PeerRequest& request, const Options& options);
  ~PeerProcess();
  PeerProcess(const PeerProcess&) = delete;
  PeerProcess& operator=(const PeerProcess&) = delete;

  /// Whether the peer was found when this was built.
  [[nodiscard]] bool is_present() const { return is_present_; }
  /// One frame, timed over there.
  [[nodiscard]] Time draw();

 private:
  [[nodiscard]] Time answer();

  std::FILE* to_ = nullptr;
  std::FILE* from_ = nullptr;
  int process_ = 0;
  bool is_present_ = false;
};

/// The other end: "PROGRAM --serve PEER SCENE THREADS KEEPS_MEMORY MODELS". Draws a frame for every line of
/// input and says how long it took, until the input ends.
void serve_peer(const char* const* arguments);

}  // namespace frontmost::bench
