# firn_module(NAME [SOURCES file...] [DEPENDS module...] [LIBRARIES target...] [PRIVATE_LIBRARIES target...])
#
# One library per module of docs/architecture.md, so that a use of a module that was not declared fails to link.
# tools/check_layers.py rejects the uses that a linker cannot see (headers).
function(firn_module name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  list(TRANSFORM arg_DEPENDS PREPEND firn_)
  if(arg_SOURCES)
    add_library(firn_${name} STATIC ${arg_SOURCES})
    target_link_libraries(firn_${name} PUBLIC firn_options ${arg_DEPENDS} ${arg_LIBRARIES} PRIVATE ${arg_PRIVATE_LIBRARIES})
  else()
    add_library(firn_${name} INTERFACE)
    target_link_libraries(firn_${name} INTERFACE firn_options ${arg_DEPENDS} ${arg_LIBRARIES})
  endif()
endfunction()
