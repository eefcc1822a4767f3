# SPDX-License-Identifier: Apache-2.0
# For a build for another kind of machine: finds this machine's header-only packages where Debian has them, but without
# the rest of this machine's headers, which would be wrong there.

set(headers ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})

# headers_of(PACKAGE TARGET FOLDER): lets find_package(PACKAGE) find TARGET, whose headers are in FOLDER.
function(headers_of package target folder)
  if(NOT EXISTS /usr/include/${folder})
    message(FATAL_ERROR "/usr/include/${folder} is not there: packages.txt names what a build needs")
  endif()
  file(CREATE_LINK /usr/include/${folder} ${headers}/${folder} SYMBOLIC)
  file(WRITE ${headers}/${package}Config.cmake "if(NOT TARGET ${target})
  add_library(${target} INTERFACE IMPORTED)
  set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${headers})
endif()\n")
  set(${package}_DIR ${headers} CACHE PATH "Written by the build" FORCE)
endfunction()

headers_of(hwy hwy::hwy hwy)
headers_of(glm glm::glm glm)
headers_of(FastFloat FastFloat::fast_float fast_float)
headers_of(nlohmann_json nlohmann_json::nlohmann_json nlohmann)

# Without Highway's library, each kernel table holds one instruction set.
add_compile_definitions(HWY_COMPILE_ONLY_STATIC)
