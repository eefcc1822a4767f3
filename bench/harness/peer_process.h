// SPDX-License-Identifier: Apache-2.0
// Peers in processes of their own, as their users run them.
//
// In our process llvmpipe would run 1.2 to 1.4 times faster than in its own. llvmpipe frees its memory after every
// frame and allocates it again for the next. glibc cannot hand that memory to the system if other blocks lie above it.
// `keeps_memory` turns the handing back off, so that both times can be reported.
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

/// A process that draws one scene with one peer on request.
class PeerProcess {
 public:
  /// \throws Error unsupported if the process does not start.
  PeerProcess(const PeerRequest& request, const Options& options);
  ~PeerProcess();
  PeerProcess(const PeerProcess&) = delete;
  PeerProcess& operator=(const PeerProcess&) = delete;

  /// Whether this build has the peer.
  [[nodiscard]] bool is_present() const { return is_present_; }
  /// Draws one frame; the other process measures the time.
  [[nodiscard]] Time draw();

 private:
  [[nodiscard]] Time answer();

  std::FILE* to_ = nullptr;
  std::FILE* from_ = nullptr;
  int process_ = 0;
  bool is_present_ = false;
};

/// Runs the other end: "PROGRAM --serve PEER SCENE THREADS KEEPS_MEMORY MODELS". For every line of input, it draws a
/// frame and reports the time, until the input ends.
void serve_peer(const char* const* arguments);

}  // namespace frontmost::bench
