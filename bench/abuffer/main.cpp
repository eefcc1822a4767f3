// SPDX-License-Identifier: Apache-2.0
// abuffer_bench [TABLE]... [--scene NAME]... [--grid N] [--threads N] [--rounds N] [--no-peers] [--json FILE]
// Measures the A-buffer beside depth peeling and its own promises; docs/performance.md says what the tables mean.
#include "abuffer/tables.h"
#include "harness/program.h"

int main(int count, char** arguments) {
  using namespace frontmost::bench;
  constexpr TableEntry kTables[] = {{"peers", measure_peeling},
                                    {"threads", measure_abuffer_threads},
                                    {"isas", measure_abuffer_isas},
                                    {"layers", measure_layers},
                                    {"memory", measure_abuffer_memory}};
  return run_program("abuffer_bench", kTables, count, arguments);
}
