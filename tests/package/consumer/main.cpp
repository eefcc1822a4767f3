// SPDX-License-Identifier: Apache-2.0
// Ten lines against the installed library.
#include <frontmost/frontmost.h>

#include <cstdio>

int main() {
  frontmost::Scene scene;
  std::printf("frontmost %s sees %llu triangles with %zu instruction sets\n", FRONTMOST_VERSION,
              static_cast<unsigned long long>(frontmost::triangle_count(scene)), frontmost::available_isas().size());
}
