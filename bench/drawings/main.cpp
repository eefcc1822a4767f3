// SPDX-License-Identifier: Apache-2.0
// drawings_bench [TABLE]... [--scene NAME]... [--rounds N] [--json FILE]
// Measures hidden lines and the painter's algorithm; docs/performance.md says what the tables mean.
#include "drawings/tables.h"
#include "harness/program.h"

int main(int count, char** arguments) {
  using namespace frontmost::bench;
  constexpr TableEntry kTables[] = {{"lines", measure_lines}, {"painter", measure_painter}, {"tones", measure_tones}};
  return run_program("drawings_bench", kTables, count, arguments);
}
