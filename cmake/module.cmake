# firn_module(NAME [SOURCES file...] [DEPENDS module...] [LIBRARIES target...] [PRIVATE_LIBRARIES target...] [KERNELS])
#
# One library per module of docs/architecture.md, so that a use of a module that was not declared fails to link.
# tools/check_layers.py rejects the uses that a linker cannot see (headers).
# KERNELS: loops over particles and nodes, whose compilation the sanitizers make three times as long. Null, misaligned and
# undersized objects are left out there: AddressSanitizer finds what they would do.
function(firn_module name)
  cmake_parse_arguments(arg "KERNELS" "" "SOURCES;DEPENDS;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  list(TRANSFORM arg_DEPENDS PREPEND firn_)
  if(arg_SOURCES)
    add_library(firn_${name} STATIC ${arg_SOURCES})
    firn_precompile(firn_${name})
    if(arg_KERNELS AND FIRN_SANITIZE MATCHES "undefined")
      target_compile_options(firn_${name} PRIVATE -fno-sanitize=null,alignment,object-size)
    endif()
    target_link_libraries(firn_${name} PUBLIC firn_options ${arg_DEPENDS} ${arg_LIBRARIES} PRIVATE ${arg_PRIVATE_LIBRARIES})
  else()
    add_library(firn_${name} INTERFACE)
    target_link_libraries(firn_${name} INTERFACE firn_options ${arg_DEPENDS} ${arg_LIBRARIES})
  endif()
endfunction()

# firn_unsanitized(file...): sources full of templates that the sanitizers would make minutes of compilation, and whose
# code they see elsewhere.
function(firn_unsanitized)
  if(FIRN_SANITIZE)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -fno-sanitize=all SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()
