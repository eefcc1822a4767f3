// SPDX-License-Identifier: Apache-2.0
// frontmost-import: reads one model from standard input and writes an answer of frames to standard output. load() runs
// it, because the libraries that read these formats crash, hang and fill memory on broken files.
//
//   frontmost-import FORMAT TOLERANCE ANGLE THREADS BYTES < part.step
//
//   FORMAT      step, iges, brep, or the suffix of a file that assimp reads
//   TOLERANCE   millimetres, 0 for the default; ANGLE: radians; THREADS: 0 for all; BYTES: greatest size of all memory
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <new>
#include <string>

#ifdef FRONTMOST_IMPORT_SHAPES
#include <Standard_Failure.hxx>
#endif

#include "import/answer.h"

namespace {

using namespace frontmost::import;

constexpr const char* input = "/proc/self/fd/0";

void limit(int resource, rlim_t most) {
  const rlimit both{most, most};
  setrlimit(resource, &both);
}

/// Keeps standard output for the answer alone. \returns the answer's descriptor.
int take_output() {
  const int answer = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nothing, STDOUT_FILENO);
  dup2(nothing, STDERR_FILENO);
  return answer;
}

bool is_shape_format(const std::string& format) { return format == "step" || format == "iges" || format == "brep"; }

void read(const std::string& format, const Tessellation& tessellation, Answer& answer) {
  if (is_shape_format(format)) {
#ifdef FRONTMOST_IMPORT_SHAPES
    return read_shapes(input, format, tessellation, answer);
#else
    throw Unreadable("this frontmost-import was built without OpenCASCADE");
#endif
  }
  (void)tessellation;
#ifdef FRONTMOST_IMPORT_POLYGONS
  std::ifstream file(input, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  return read_polygons(bytes, format, answer);
#else
  throw Unreadable("this frontmost-import was built without assimp");
#endif
}

}  // namespace

int main(int count, char** words) {
  if (count == 2 && std::string(words[1]) == "--formats") {
#ifdef FRONTMOST_IMPORT_SHAPES
    std::puts("step iges brep");
#endif
#ifdef FRONTMOST_IMPORT_POLYGONS
    std::puts(polygon_suffixes().c_str());
#endif
    return 0;
  }
  if (count != 6) {
    std::fputs(
        "usage: frontmost-import FORMAT TOLERANCE ANGLE THREADS BYTES < MODEL\n"
        "       frontmost-import --formats\n"
        "frontmost runs this program to read STEP, IGES and BREP files, and other formats of meshes.\n",
        stderr);
    return 2;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_AS, std::strtoull(words[5], nullptr, 10));
  Answer answer(take_output());
  Tessellation tessellation;
  tessellation.tolerance = std::strtod(words[2], nullptr);
  tessellation.angle = std::strtod(words[3], nullptr);
  tessellation.in_parallel = std::string(words[4]) != "1";
  try {
    read(words[1], tessellation, answer);
    return 0;
  } catch (const std::bad_alloc&) {
    answer.error("it needs more memory than is allowed");
#ifdef FRONTMOST_IMPORT_SHAPES
  } catch (const Standard_Failure& failure) {
    answer.error(std::string("OpenCASCADE fails: ") + failure.GetMessageString());
#endif
  } catch (const std::exception& error) {
    answer.error(error.what());
  }
  return 1;
}
