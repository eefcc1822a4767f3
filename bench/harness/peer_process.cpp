// SPDX-License-Identifier: Apache-2.0
#include "harness/peer_process.h"

#include <fcntl.h>
#include <malloc.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <climits>
#include <cstdlib>

#include "harness/scenes.h"
#include "peers/peer.h"

extern char** environ;

namespace frontmost::bench {
namespace {

[[noreturn]] void fail(const char* what) {
  throw Error(ErrorCode::unsupported, std::string("peer process: ").append(what));
}

/// Starts this program again with other arguments; `input` and `output` are ends of pipes.
pid_t start(std::array<std::string, 7> arguments, int input, int output) {
  std::array<char*, 8> pointers{};
  for (std::size_t i = 0; i < arguments.size(); ++i) pointers[i] = arguments[i].data();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  pid_t process = 0;
  const int error = posix_spawn(&process, "/proc/self/exe", &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) fail("it does not start");
  return process;
}

std::unique_ptr<Peer> make_peer(std::string_view name, const PeerInput& input) {
  if (name == "llvmpipe") return make_llvmpipe(input);
  if (name == "peeling") return make_peeling(input);
  return make_embree(input);
}

void say(const Time& time) {
  std::printf("%.6f %.6f\n", time.wall, time.processor);
  std::fflush(stdout);
}

}  // namespace

PeerProcess::PeerProcess(const PeerRequest& request, const Options& options) {
  std::array<int, 2> input{}, output{};
  if (pipe2(input.data(), O_CLOEXEC) != 0 || pipe2(output.data(), O_CLOEXEC) != 0) fail("no pipe");
  process_ = start({"peer", "--serve", request.peer, request.scene, std::to_string(request.threads),
                    request.keeps_memory ? "1" : "0", options.models},
                   input[0], output[1]);
  close(input[0]);
  close(output[1]);
  to_ = fdopen(input[1], "w");
  from_ = fdopen(output[0], "r");
  is_present_ = answer().wall >= 0;
}

PeerProcess::~PeerProcess() {
  std::fclose(to_);
  std::fclose(from_);
  waitpid(process_, nullptr, 0);
}

Time PeerProcess::answer() {
  Time time;
  if (std::fscanf(from_, "%lf %lf", &time.wall, &time.processor) != 2) fail("it ended early");
  return time;
}

Time PeerProcess::draw() {
  std::fputs("draw\n", to_);
  std::fflush(to_);
  return answer();
}

void serve_peer(const char* const* arguments) {
#if defined(__GLIBC__)
  // Unless set, glibc raises both thresholds to the largest block that was ever freed, here while the scene is made.
  constexpr int kInitialThreshold = 128 * 1024, kNever = 1 << 30;
  const int threshold = std::atoi(arguments[3]) != 0 ? kNever : kInitialThreshold;
  mallopt(M_TRIM_THRESHOLD, threshold);
  mallopt(M_MMAP_THRESHOLD, threshold);
#endif
  const Scene scene = make_scene(arguments[1], arguments[4]);
  Box bounds;
  for (const glm::vec3& position : scene.meshes.at(0).positions) bounds.include(position);
  const View view = make_view(bounds, find_scene(arguments[1]).camera);
  const std::unique_ptr<Peer> peer = make_peer(arguments[0], {scene, view, std::atoi(arguments[2])});
  // Reports that the peer is ready, or absent.
  say({peer ? 0.0 : -1.0, 0});
  for (char line[16]; peer && std::fgets(line, sizeof line, stdin) != nullptr;) {
    const Time before = now();
    peer->draw();
    const Time after = now();
    say({after.wall - before.wall, after.processor - before.processor});
  }
}

}  // namespace frontmost::bench
