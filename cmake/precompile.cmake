# Headers of the standard library, fmt, TBB and GoogleTest, parsed once for all: without, a build takes half as long again.
# firn_add_precompiled(NAME [target...]) makes the set of cmake/precompiled_NAME.h, which needs these targets;
# firn_precompile(TARGET [NAME]) gives it to a target, the set `sources` if not named.
# No file may rely on them: FIRN_PRECOMPILE=OFF builds the same, and tools/check_headers.py looks for includes that lack.
function(firn_add_precompiled name)
  if(NOT FIRN_PRECOMPILE)
    return()
  endif()
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled_${name}.cc CONTENT "")
  add_library(firn_precompiled_${name} OBJECT ${PROJECT_BINARY_DIR}/precompiled_${name}.cc)
  target_link_libraries(firn_precompiled_${name} PRIVATE firn_options fmt::fmt TBB::tbb ${ARGN})
  target_precompile_headers(firn_precompiled_${name} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled_${name}.h)
endfunction()

function(firn_precompile target)
  set(name sources)
  if(ARGC GREATER 1)
    set(name ${ARGV1})
  endif()
  if(FIRN_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM firn_precompiled_${name})
  endif()
endfunction()
