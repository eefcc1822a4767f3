// SPDX-License-Identifier: Apache-2.0
// zbuffer_bench [TABLE]... [--scene NAME]... [--threads N] [--rounds N] [--large] [--no-peers] [--json FILE]
// Measures the z-buffer beside its peers and its own promises; docs/performance.md says what the tables mean.
#include "harness/program.h"
#include "harness/tables.h"

int main(int count, char** arguments) {
  using namespace frontmost::bench;
  constexpr TableEntry kTables[] = {
      {"peers", measure_peers},       {"threads", measure_threads},   {"isas", measure_isas},
      {"stages", measure_stages},     {"features", measure_features}, {"limits", measure_limits},
      {"memory", measure_memory},     {"surfaces", measure_surfaces}, {"coverage", measure_coverage},
      {"rays", measure_ray_coverage}, {"raycast", measure_raycast},   {"depth", measure_depth_buffer},
      {"scans", measure_scans},       {"accounts", measure_accounts}, {"reports", measure_reports},
      {"faces", measure_faces},       {"fights", measure_fights}};
  return run_program("zbuffer_bench", kTables, count, arguments);
}
